// CAN sink for a Linux CAN interface (SocketCAN).
#pragma once

#include "platform/can/can_sink.hpp"

namespace glint {

// See open_can_sink. The bit rates belong to the interface and are set with `ip link`.
[[nodiscard]] std::unique_ptr<CanSink> open_socketcan_sink(const std::string& interface,
                                                           const CanSinkOptions& options);

}  // namespace glint
