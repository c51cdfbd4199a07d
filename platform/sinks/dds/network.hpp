// Complete configuration of Cyclone DDS: no configuration file, no environment variable, one
// interface.
#pragma once

#include <cstddef>
#include <string>

#include "platform/sinks/dds/dds_settings.hpp"

namespace glint {

// Throws MissingDevice if the interface does not exist, is down or has no IPv4 address. The message
// lists the available interfaces, which Cyclone's own does not.
void require_network_interface(const std::string& name);

// Larger messages are dropped, sent or received.
inline constexpr std::size_t k_message_bytes_max = std::size_t{16} << 20;

// Cyclone's configuration as XML: this interface only; on loopback only unicast to this machine.
[[nodiscard]] std::string cyclone_configuration(const DdsSettings& settings);

}  // namespace glint
