#include "platform/sinks/dds/received_messages.hpp"

#include <cmath>
#include <cstring>

namespace glint {
namespace {

constexpr double k_unit_tolerance = 0.01;  // of a quaternion's norm, for rounded inputs

bool read_name(const char* text, std::size_t length_min, BoundedName& to) {
  if (text == nullptr) return false;
  const std::size_t length = ::strnlen(text, to.size());
  if (length < length_min || length > k_received_name_max) return false;
  to = {};
  std::memcpy(to.data(), text, length);
  return true;
}

Time time_of_message(const TimeMessage& stamp, Duration unix_minus_session, Time arrival) {
  const bool stamped = stamp.sec != 0 || stamp.nanosec != 0;
  return stamped ? time_of(stamp) - unix_minus_session : arrival;
}

}  // namespace

bool read_message(const JointStateMessage& message, Duration unix_minus_session, Time arrival,
                  ReceivedJoints& to) {
  const std::uint32_t count = message.name._length;
  if (count < 1 || count > static_cast<std::uint32_t>(k_received_joints_max)) return false;
  if (message.position._length != count) return false;
  for (std::uint32_t i = 0; i < count; ++i) {
    to.positions[i] = message.position._buffer[i];
    if (!std::isfinite(to.positions[i])) return false;
    if (!read_name(message.name._buffer[i], 1, to.names[i])) return false;
  }
  to.count = static_cast<int>(count);
  to.time = time_of_message(message.header.stamp, unix_minus_session, arrival);
  return true;
}

bool read_message(const PoseCovarianceMessage& message, Duration unix_minus_session, Time arrival,
                  ReceivedInitialPose& to) {
  const auto& p = message.pose.pose.position;
  const auto& q = message.pose.pose.orientation;
  to.pose.translation = Vector3(p.x, p.y, p.z);
  const Quaternion rotation(q.w, q.x, q.y, q.z);
  if (!to.pose.translation.allFinite() || !rotation.coeffs().allFinite()) return false;
  if (std::abs(rotation.norm() - 1) > k_unit_tolerance) return false;
  to.pose.rotation = rotation.normalized();
  for (int i = 0; i < 36; ++i) {
    const double number = message.pose.covariance[i];
    if (!std::isfinite(number)) return false;
    to.covariance(i / 6, i % 6) = number;
  }
  if (!read_name(message.header.frame_id, 0, to.frame)) return false;
  to.time = time_of_message(message.header.stamp, unix_minus_session, arrival);
  return true;
}

bool read_message(const TextMessage& message, ReceivedDescription& to) {
  if (message.data == nullptr) return false;
  const std::size_t length = ::strnlen(message.data, k_received_description_max + 1);
  if (length < 1 || length > k_received_description_max) return false;
  to.urdf.assign(message.data, length);
  return true;
}

std::size_t positions_of(const ReceivedJoints& joints, std::span<const std::string> names,
                         std::span<double> positions) noexcept {
  for (std::size_t n = 0; n < names.size(); ++n) {
    int times = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(joints.count); ++i) {
      if (names[n] != joints.names[i].data()) continue;
      positions[n] = joints.positions[i];
      ++times;
    }
    if (times != 1) return n;
  }
  return names.size();
}

}  // namespace glint
