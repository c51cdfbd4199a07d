// Live view of a run: a WebSocket server of protocol foxglove.websocket.v1, which Foxglove,
// Lichtblick and other clients open. Its channels and messages are those of the run's recording.
//
// A client that reads slowly delays neither the recording nor other clients (view_queue.hpp). Each
// message is sent in fragments, so that the library stores at most one of them a client.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "platform/sinks/record/message_observer.hpp"
#include "platform/sinks/view/view_queue.hpp"

namespace glint {

struct FoxgloveSettings {
  std::string address = "127.0.0.1";  // of the interface that it listens on
  int port = 8765;                    // 0: any free one
  std::size_t queue_bytes = std::size_t{32} << 20;
  int clients_max = 256;
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
