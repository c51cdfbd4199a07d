// Return path to a headset: a WebSocket server whose messages a client on the headset draws.
//
// The tick thread copies a sample into a bounded queue. The server's thread reads it every 5 ms and
// sends each client the newest messages (headset_messages.hpp), when the client's socket has room.
// A client that reads slowly, or that no longer exists, delays nothing: messages that newer ones
// replace are counted.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "platform/sinks/headset/headset_output.hpp"

namespace glint {

struct HeadsetSettings {
  std::string address = "127.0.0.1";  // of the interface that it listens on
  int port = 8766;                    // 0: any free one
  std::vector<std::string> tool_names;
};

class HeadsetServer final : public HeadsetOutput {
 public:
  static constexpr int k_queue_size = 1024;  // 4 s of one tool at 250 Hz
  static constexpr std::size_t k_clients_max = 4;

  // Throws MissingDevice if the address cannot be listened on.
  explicit HeadsetServer(const HeadsetSettings& settings);
  ~HeadsetServer() override;  // closes
  HeadsetServer(const HeadsetServer&) = delete;
  HeadsetServer& operator=(const HeadsetServer&) = delete;

  void offer(const HeadsetSample& sample) noexcept override;
  [[nodiscard]] int port() const;
  // Sends the newest messages, for at most half a second, and disconnects all clients.
  void close();
  [[nodiscard]] HeadsetCounts counts() const;

 private:
  struct Body;
  std::unique_ptr<Body> body_;
};

}  // namespace glint
