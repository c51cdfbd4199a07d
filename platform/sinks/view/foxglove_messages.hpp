// Messages of protocol foxglove.websocket.v1 (github.com/foxglove/ws-protocol, docs/spec.md).
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

inline constexpr std::size_t k_subscriptions_max = 1024;  // of one client, and of one request

struct Subscription {
  std::uint32_t id = 0;  // chosen by the client
  std::size_t channel_index = 0;
  [[nodiscard]] bool operator<(const Subscription& other) const { return id < other.id; }
};

struct RequestedChannel {
  std::uint32_t id = 0, channel = 0;
};

struct Request {
  std::vector<RequestedChannel> begun;
  std::vector<std::uint32_t> ended;  // subscriptions' ids
};

// From client to server: subscribe or unsubscribe. Nothing for any other text.
[[nodiscard]] std::optional<Request> request_of(std::string_view text);

// From server to client: JSON.
[[nodiscard]] std::string server_info();
[[nodiscard]] std::string channel_json(std::uint32_t channel, std::string_view topic,
                                       std::string_view type, std::string_view schema);
[[nodiscard]] std::string advertise(const std::vector<std::string>& channels);
[[nodiscard]] std::string error_status(const std::string& message);

// Head of a binary message: operation 1, the subscription, the time; little endian. CDR follows.
[[nodiscard]] std::vector<std::uint8_t> message_head(std::uint32_t subscription,
                                                     std::uint64_t unix_ns);

[[nodiscard]] inline std::vector<std::uint8_t> text_bytes(std::string_view text) {
  return {text.begin(), text.end()};
}

}  // namespace glint
