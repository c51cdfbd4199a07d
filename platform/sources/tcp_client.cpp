#include "platform/sources/tcp_client.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>

#include <cerrno>
#include <cstring>

#include "platform/input_error.hpp"
#include "platform/runtime/rt/clock.hpp"

namespace glint {
namespace {

int milliseconds_of(Duration limit) { return static_cast<int>(limit.nanoseconds / 1'000'000); }

}  // namespace

TcpPeer tcp_peer(const std::string& host, int port) {
  TcpPeer peer;
  peer.name = host + ":" + std::to_string(port);
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int code = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (code != 0) {
    throw MissingDevice(peer.name + ": " + ::gai_strerror(code) +
                        "; expected the address or the name of a headset");
  }
  std::memcpy(&peer.address, found->ai_addr, found->ai_addrlen);
  peer.address_bytes = found->ai_addrlen;
  ::freeaddrinfo(found);
  return peer;
}

std::optional<Descriptor> tcp_connect(const TcpPeer& peer, Duration limit,
                                      std::span<const std::uint8_t> request, std::string& why) {
  Descriptor socket(
      ::socket(peer.address.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  int error = 0;
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&peer.address),
                peer.address_bytes) != 0) {
    error = errno;
  }
  if (error == EINPROGRESS) {
    pollfd waited{socket.get(), POLLOUT, 0};
    socklen_t bytes = sizeof error;
    if (::poll(&waited, 1, milliseconds_of(limit)) <= 0) {
      error = ETIMEDOUT;
    } else if (::getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &bytes) != 0) {
      error = errno;
    }
  }
  if (error == 0 && ::send(socket.get(), request.data(), request.size(), MSG_NOSIGNAL) !=
                        static_cast<ssize_t>(request.size())) {
    error = errno;
  }
  if (error == 0) return socket;
  why = std::strerror(error);
  return std::nullopt;
}

std::optional<std::size_t> tcp_receive(int socket, std::span<std::uint8_t> to, std::string& why) {
  const ssize_t got = ::recv(socket, to.data(), to.size(), 0);
  if (got > 0) return static_cast<std::size_t>(got);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
  why = got == 0 ? "closed by the server" : std::strerror(errno);
  return std::nullopt;
}

void tcp_wait(int socket, Duration limit) {
  pollfd waited{socket, POLLIN, 0};
  (void)::poll(&waited, 1, milliseconds_of(limit));
}

std::optional<std::vector<std::uint8_t>> tcp_answer(const TcpPeer& peer, const TcpLimits& limits,
                                                    std::span<const std::uint8_t> request,
                                                    std::size_t bytes, std::string& why) {
  const auto connection = tcp_connect(peer, limits.connect, request, why);
  if (!connection) return std::nullopt;
  std::vector<std::uint8_t> answer(bytes);
  std::size_t filled = 0;
  Time last = monotonic_now();
  while (filled < bytes) {
    tcp_wait(connection->get(), limits.silence);
    const auto got = tcp_receive(connection->get(), std::span(answer).subspan(filled), why);
    if (got && *got > 0) {
      filled += *got;
      last = monotonic_now();
    } else if (!got || monotonic_now() - last > limits.silence) {
      why = "the answer ends after " + std::to_string(filled) + " of " + std::to_string(bytes) +
            " bytes";
      return std::nullopt;
    }
  }
  return answer;
}

}  // namespace glint
