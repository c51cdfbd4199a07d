// Queue of messages that all clients of a live view share, with a position for each client.
//
// A message is copied once, and only if a client subscribes to its channel. The queue has a fixed
// capacity in bytes and drops the oldest; a client that was behind continues after them, and they
// are counted. Small messages are also kept as the newest of their channel: a client that
// subscribes later starts with it. Thread-safe; a call holds the lock for one copy at most.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "platform/sinks/view/foxglove_messages.hpp"

namespace glint {

struct FoxgloveCounts {
  std::uint64_t clients = 0;  // accepted so far
  // Too many, another protocol, a page of another origin; HTTP requests for anything but the page,
  // and connections that end without a complete request.
  std::uint64_t refused = 0;
  std::uint64_t invalid = 0;   // requests that are not of the protocol, and unknown channels
  std::uint64_t messages = 0;  // sent, over all clients
  std::uint64_t dropped = 0;   // left the queue before a client's turn; of any channel
};

inline constexpr std::size_t k_newest_bytes_max = std::size_t{4} << 10;

struct ViewMessage {
  std::uint64_t number = 0;  // rises by one in the queue; 0: only the newest of its channel
  std::uint16_t channel = 0;
  std::uint64_t unix_ns = 0;
  std::vector<std::uint8_t> cdr;
};

// What is sent to one client next.
struct Outgoing {
  std::vector<std::uint8_t> head;              // text, or the head of a binary message
  std::shared_ptr<const ViewMessage> message;  // its rest; null: text
  std::size_t sent = 0;                        // bytes

  [[nodiscard]] std::size_t size() const {
    return head.size() + (message != nullptr ? message->cdr.size() : 0);
  }
};

// A client's position. Used by one thread.
struct ViewClient {
  std::set<Subscription> subscriptions;
  std::size_t advertised = 0;  // channels
  std::uint64_t next = 0;      // number of the next message
  std::deque<Outgoing> waiting;
};

class ViewQueue {
 public:
  explicit ViewQueue(std::size_t bytes_max) : bytes_max_(bytes_max) {}

  void add_channel(std::uint16_t channel, std::string_view topic, std::string_view type,
                   std::string_view schema);
  // Returns whether a client subscribes to the channel. Messages of an unknown one are ignored.
  [[nodiscard]] bool add_message(std::uint16_t channel, std::uint64_t unix_ns,
                                 std::span<const std::uint8_t> cdr);

  void enter(ViewClient& client);
  void leave(ViewClient& client);
  void refuse();
  // Applies a request's text; what answers it is appended to `waiting`.
  void apply(ViewClient& client, std::string_view request);
  // Appends the next channels or the next message of the client to `waiting`, if there are any.
  void enqueue_next(ViewClient& client);
  [[nodiscard]] bool is_at_end(const ViewClient& client) const;
  [[nodiscard]] FoxgloveCounts counts() const;

 private:
  struct Channel {
    std::string advertisement;  // JSON of one channel
    std::uint16_t number = 0;
    int subscribers = 0;
    std::shared_ptr<const ViewMessage> newest;
  };
  Channel* find(std::uint32_t number);
  std::uint64_t skip_dropped(ViewClient& client);
  void reject(ViewClient& client, const std::string& why);
  void subscribe(ViewClient& client, const RequestedChannel& wanted);

  mutable std::mutex mutex_;
  std::size_t bytes_max_;
  std::vector<Channel> channels_;
  std::deque<std::shared_ptr<const ViewMessage>> queue_;
  std::size_t bytes_ = 0;
  std::uint64_t next_number_ = 1;
  FoxgloveCounts counts_;
};

}  // namespace glint
