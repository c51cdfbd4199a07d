// Opens, binds and checks a raw socket on a Linux CAN interface, for sending and receiving.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kernels/wire/can_frame.hpp"
#include "platform/descriptor.hpp"

namespace glint {

// Receives only frames with the 11-bit identifier `identifier_filter`, remote requests included;
// without one, none, so that the bus traffic does not fill the queue. Reads and writes do not
// block. Throws InputError for a name that is invalid on Linux. Throws MissingDevice, with its
// name, for an interface that does not exist, is down, is not CAN or, for `format` fd, has no CAN
// FD.
[[nodiscard]] Descriptor open_socketcan(const std::string& interface, CanFormat format,
                                        std::optional<std::uint32_t> identifier_filter = {});

}  // namespace glint
