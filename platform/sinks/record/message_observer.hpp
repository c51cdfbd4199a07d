// Observer of the messages that a recording is made of, for example a live view.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace glint {

// Called by the thread that writes the recording, never by a frame or tick thread.
class MessageObserver {
 public:
  virtual ~MessageObserver() = default;
  // `channel` is the number of later messages; `schema` is the ros2msg text of `type`.
  virtual void add_channel(std::uint16_t channel, std::string_view topic, std::string_view type,
                           std::string_view schema) = 0;
  // unix_ns: log time of the message. cdr: with its encapsulation, as in the file.
  virtual void add_message(std::uint16_t channel, std::uint64_t unix_ns,
                           std::span<const std::uint8_t> cdr) = 0;
};

}  // namespace glint
