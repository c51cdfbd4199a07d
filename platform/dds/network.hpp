// Cyclone DDS is told everything here: no configuration file, no environment, no other interface.
#pragma once

#include <cstddef>
#include <string>

#include "platform/dds/dds_settings.hpp"

namespace glint {

// Throws MissingDevice, naming the interface and those that there are, when it does not exist, is
// down or has no IPv4 address. Cyclone's own message for this names none of them.
void require_network_interface(const std::string& name);

// Larger messages are dropped on their way, in or out.
inline constexpr std::size_t k_message_bytes_max = std::size_t{16} << 20;

// Cyclone's configuration as XML: this interface alone; on loopback unicast to this machine only.
[[nodiscard]] std::string cyclone_configuration(const DdsSettings& settings);

}  // namespace glint
