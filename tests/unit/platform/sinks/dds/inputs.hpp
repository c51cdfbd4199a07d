// Messages as a robot's driver or RViz sends them.
#pragma once

#include <string>
#include <vector>

#include "platform/sinks/dds/messages.hpp"
#include "platform/sinks/dds/received_messages.hpp"
#include "platform/sinks/dds/serialiser.hpp"
#include "platform/sinks/dds/topic_types.hpp"

namespace glint {

// Serialised as by a sender.
inline std::vector<std::uint8_t> bytes_of(const JointStateMessage& message) {
  Serialiser serialiser;
  const auto bytes = serialiser.bytes_of(joint_state_type(), &message);
  return {bytes.begin(), bytes.end()};
}
inline std::vector<std::uint8_t> bytes_of(const PoseCovarianceMessage& message) {
  Serialiser serialiser;
  const auto bytes = serialiser.bytes_of(pose_covariance_type(), &message);
  return {bytes.begin(), bytes.end()};
}
inline std::vector<std::uint8_t> bytes_of(const TextMessage& message) {
  Serialiser serialiser;
  const auto bytes = serialiser.bytes_of(text_type(), &message);
  return {bytes.begin(), bytes.end()};
}

// Owns the strings and arrays that a message points to.
class JointText {
 public:
  JointText(std::vector<std::string> names, std::vector<double> positions)
      : names_(std::move(names)), positions_(std::move(positions)) {
    for (std::string& name : names_) texts_.push_back(name.data());
  }
  JointText(const JointText& other) : JointText(other.names_, other.positions_) {}
  JointText& operator=(const JointText&) = delete;

  [[nodiscard]] JointStateMessage message() {
    JointStateMessage message{};
    message.header.frame_id = empty_.data();
    message.name._length = message.name._maximum = static_cast<std::uint32_t>(texts_.size());
    message.name._buffer = texts_.data();
    message.position._length = message.position._maximum =
        static_cast<std::uint32_t>(positions_.size());
    message.position._buffer = positions_.data();
    return message;
  }

 private:
  std::vector<std::string> names_;
  std::vector<double> positions_;
  std::vector<char*> texts_;
  std::string empty_;
};

inline PoseCovarianceMessage guess_message(std::string& frame) {
  PoseCovarianceMessage message{};
  message.header.frame_id = frame.data();
  message.pose.pose.position = {1, 2, 3};
  message.pose.pose.orientation = {0, 0, 1.004, 0};  // rounded, as by other programs
  for (int i = 0; i < 36; ++i) message.pose.covariance[i] = i;
  return message;
}

}  // namespace glint
