// Linux' own CAN: frames to an interface that the kernel knows.
#pragma once

#include "platform/can/can_sink.hpp"

namespace glint {

// See open_can_sink. The bit rates are the interface's own and set with `ip link`.
[[nodiscard]] std::unique_ptr<CanSink> open_socketcan_sink(const std::string& interface,
                                                           const CanSinkOptions& options);

}  // namespace glint
