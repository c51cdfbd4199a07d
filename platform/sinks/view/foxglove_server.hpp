// Live view of a run: a WebSocket server of protocol foxglove.websocket.v1, which Foxglove,
// Lichtblick and other clients open. Its channels and messages are those of the run's recording.
//
// add_message() copies a message once into a queue that all clients share, and only if a client
// subscribes to its channel. The queue has a fixed capacity in bytes. A client that reads more
// slowly loses the oldest messages, which are counted; it delays neither the recording nor other
// clients. Each message is sent in fragments, so that the library stores at most one of them a
// client.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "platform/sinks/record/message_observer.hpp"

namespace glint {

struct FoxgloveSettings {
  std::string address = "127.0.0.1";  // of the interface that it listens on
  int port = 8765;                    // 0: any free one
  std::size_t queue_bytes = std::size_t{32} << 20;
  int clients_max = 256;
};

struct FoxgloveCounts {
  std::uint64_t clients = 0;   // accepted so far
  std::uint64_t refused = 0;   // too many, another protocol, or a page of another origin
  std::uint64_t invalid = 0;   // requests that are no JSON of the protocol
  std::uint64_t messages = 0;  // sent, over all clients
  std::uint64_t dropped = 0;   // left the queue before a client's turn; of any channel
};

class FoxgloveServer : public MessageObserver {
 public:
  // Throws MissingDevice if the address cannot be listened on.
  explicit FoxgloveServer(const FoxgloveSettings& settings);
  ~FoxgloveServer() override;  // closes
  FoxgloveServer(const FoxgloveServer&) = delete;
  FoxgloveServer& operator=(const FoxgloveServer&) = delete;

  [[nodiscard]] int port() const;
  [[nodiscard]] FoxgloveCounts counts() const;

  void add_channel(std::uint16_t channel, std::string_view topic, std::string_view type,
                   std::string_view schema) override;
  void add_message(std::uint16_t channel, std::uint64_t unix_ns,
                   std::span<const std::uint8_t> cdr) override;

  // Sends what is queued, for at most half a second, and disconnects all clients.
  void close();

 private:
  struct Body;
  std::unique_ptr<Body> body_;
};

}  // namespace glint
