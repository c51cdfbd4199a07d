// A socket on one of Linux' CAN interfaces, bound and checked: for what sends and for what hears.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kernels/wire/can_frame.hpp"
#include "platform/can/descriptor.hpp"

namespace glint {

// Of the bus only frames with the 11-bit identifier `heard` are received, remote requests among
// them; without one nothing is, or the bus' traffic would fill the queue. Neither read nor write
// blocks. Throws InputError for a name that Linux cannot have; MissingDevice naming the interface
// that is not there, not up, not a CAN interface or, for `format` fd, without CAN FD.
[[nodiscard]] Descriptor open_socketcan(const std::string& interface, CanFormat format,
                                        std::optional<std::uint32_t> heard = {});

}  // namespace glint
