// Whether a server can listen on a port.
#pragma once

#include <string>

namespace glint {

// libwebsockets waits for an address that this machine lacks instead of reporting it, and loses
// memory on a port that is in use. `address`: IPv4.
[[nodiscard]] bool is_free_port(const std::string& address, int port);

}  // namespace glint
