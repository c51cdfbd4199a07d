// Start of glint_lab, the program of the experiments and of the baseline method.
#pragma once

namespace glint {

// Replaces this process by the glint_lab in its folder, with the same arguments. Returns only by
// MissingDevice: glint_lab is not there.
[[noreturn]] void start_lab();

}  // namespace glint
