// Client side of a TCP connection: connects, sends one request, receives without blocking.
#pragma once

#include <sys/socket.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/units.hpp"
#include "platform/descriptor.hpp"

namespace glint {

struct TcpPeer {
  std::string name;  // host:port, for messages
  sockaddr_storage address{};
  socklen_t address_bytes = 0;
};

// Throws MissingDevice if the host has no address.
[[nodiscard]] TcpPeer tcp_peer(const std::string& host, int port);

// Connects within `limit` and sends `request`, which fits into a socket's buffer. Empty on failure;
// `why` then holds the reason.
[[nodiscard]] std::optional<Descriptor> tcp_connect(const TcpPeer& peer, Duration limit,
                                                    std::span<const std::uint8_t> request,
                                                    std::string& why);

// Receives what has arrived, at most `to.size()` bytes. Returns the number of bytes, 0 if none has
// arrived; empty at the end of the connection, with the reason in `why`.
[[nodiscard]] std::optional<std::size_t> tcp_receive(int socket, std::span<std::uint8_t> to,
                                                     std::string& why);

// Waits until bytes have arrived or `limit` is over.
void tcp_wait(int socket, Duration limit);

struct TcpLimits {
  Duration connect;
  Duration silence;  // without a byte
};

// Connects, sends `request` and receives an answer of `bytes` bytes. Empty on failure; `why` then
// holds the reason.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> tcp_answer(
    const TcpPeer& peer, const TcpLimits& limits, std::span<const std::uint8_t> request,
    std::size_t bytes, std::string& why);

}  // namespace glint
