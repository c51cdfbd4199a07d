// CAN sink for a Linux CAN interface (SocketCAN).
#pragma once

#include "platform/descriptor.hpp"
#include "platform/sinks/can/can_sink.hpp"

namespace glint {

// See open_can_sink. The bit rates belong to the interface and are set with `ip link`.
[[nodiscard]] std::unique_ptr<CanSink> open_socketcan_sink(const std::string& interface,
                                                           const CanSinkOptions& options);

// To an open socket that takes one struct can_frame or canfd_frame a write and does not block.
[[nodiscard]] std::unique_ptr<CanSink> socketcan_sink_of(Descriptor socket);

}  // namespace glint
