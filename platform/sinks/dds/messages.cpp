#include "platform/sinks/dds/messages.hpp"

#include <algorithm>
#include <limits>

namespace glint {
namespace {

constexpr std::int64_t k_second_ns = 1'000'000'000;

}  // namespace

// Hashes as published with ROS 2; TrackStatus's is computed by the same rule, see README.md.
TopicType pose_stamped_type() {
  return {&geometry_msgs_msg_dds__PoseStamped__desc,
          "10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8"};
}
TopicType pose_covariance_type() {
  return {&geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc,
          "26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e"};
}
TopicType tf_type() {
  return {&tf2_msgs_msg_dds__TFMessage__desc,
          "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"};
}
TopicType diagnostics_type() {
  return {&diagnostic_msgs_msg_dds__DiagnosticArray__desc,
          "5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"};
}
TopicType status_type() {
  return {&glint_msgs_msg_dds__TrackStatus__desc,
          "bf775085475a36553660bc37bce6ce49b109795637f22907fb75ee6d21574c7c"};
}

TimeMessage time_message(Time unix_time) {
  constexpr std::int64_t last = std::numeric_limits<std::int32_t>::max();
  const std::int64_t ns =
      std::clamp<std::int64_t>(unix_time.nanoseconds, 0, last * k_second_ns + k_second_ns - 1);
  return {static_cast<std::int32_t>(ns / k_second_ns),
          static_cast<std::uint32_t>(ns % k_second_ns)};
}

Time time_of(const TimeMessage& stamp) {
  return {std::int64_t{stamp.sec} * k_second_ns + std::int64_t{stamp.nanosec}};
}

HeaderMessage header_message(Time unix_time, const char* frame) {
  return {time_message(unix_time), borrowed(frame)};
}

PoseMessage pose_message(const Pose& pose) {
  const Vector3& t = pose.translation;
  const Quaternion& q = pose.rotation;
  return {{t.x(), t.y(), t.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

PoseCovarianceMessage pose_covariance_message(const HeaderMessage& header, const Pose& pose,
                                              const Matrix6& covariance) {
  PoseCovarianceMessage message{};
  message.header = header;
  message.pose.pose = pose_message(pose);
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      message.pose.covariance[6 * row + column] = covariance(row, column);
    }
  }
  return message;
}

TransformMessage transform_message(const HeaderMessage& header, const char* child,
                                   const Pose& T_frame_child) {
  const PoseMessage pose = pose_message(T_frame_child);
  return {header,
          borrowed(child),
          {{pose.position.x, pose.position.y, pose.position.z}, pose.orientation}};
}

}  // namespace glint
