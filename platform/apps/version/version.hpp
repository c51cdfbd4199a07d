// Version text of `glint --version`.
#pragma once

namespace glint {

// "glint 0.1.0 (commit 0123456789ab)", from the file that write_version.cmake makes at each build.
[[nodiscard]] const char* version_text();

}  // namespace glint
