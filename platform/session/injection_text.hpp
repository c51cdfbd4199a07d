// Injected delays as they are asked for: "node=FindBlobs,delay_us=200,frame=512" or, of the tick
// group, "node=PackCan,delay_us=200,tick=40"; copy i of a split is "RoiThreshold#i".
#pragma once

#include <string>

#include "platform/session/node_probe.hpp"

namespace glint {

// Throws InputError: what was found, what was expected.
[[nodiscard]] Injection injection_of(const std::string& text);

}  // namespace glint
