#include "platform/sinks/record/ros_messages.hpp"

#include <algorithm>

namespace glint {

std::string_view frame_name(ReferenceFrame frame) {
  switch (frame) {
    case ReferenceFrame::camera:
      return k_camera_frame;
    case ReferenceFrame::world:
      return k_world_frame;
    case ReferenceFrame::robot:
      return k_robot_frame;
  }
  return k_camera_frame;
}

void put_header(CdrWriter& to, Time since_1970, std::string_view frame) {
  constexpr std::int64_t k_second = 1'000'000'000;
  constexpr std::int64_t k_last_second = 0x7FFFFFFF;
  const std::int64_t time =
      std::clamp<std::int64_t>(since_1970.nanoseconds, 0, k_last_second * k_second + k_second - 1);
  to.put(static_cast<std::int32_t>(time / k_second));
  to.put(static_cast<std::uint32_t>(time % k_second));
  to.put(frame);
}

void put_vector(CdrWriter& to, const Vector3& vector) {
  for (int axis = 0; axis < 3; ++axis) to.put(vector[axis]);
}

void put_pose(CdrWriter& to, const Pose& pose) {
  put_vector(to, pose.translation);
  to.put(pose.rotation.x());
  to.put(pose.rotation.y());
  to.put(pose.rotation.z());
  to.put(pose.rotation.w());
}

void write_pose_stamped(CdrWriter& to, Time since_1970, const PoseSample& sample) {
  to.begin();
  put_header(to, since_1970, frame_name(sample.frame));
  put_pose(to, sample.pose);
}

void write_pose_with_covariance(CdrWriter& to, Time since_1970, const PoseSample& sample) {
  write_pose_stamped(to, since_1970, sample);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) to.put(sample.covariance(row, column));
}

void write_transform(CdrWriter& to, Time since_1970, std::string_view parent,
                     std::string_view child, const Pose& T_parent_child) {
  to.begin();
  to.put_length(1);
  put_header(to, since_1970, parent);
  to.put(child);
  put_pose(to, T_parent_child);  // a Transform has the same bytes as a Pose
}

void write_image(CdrWriter& to, Time since_1970, const ImageShape& shape,
                 std::span<const std::uint8_t> rows) {
  to.begin();
  put_header(to, since_1970, k_camera_frame);
  to.put(shape.height);
  to.put(shape.width);
  to.put(shape.encoding);
  to.put(std::uint8_t{0});  // little endian
  to.put(shape.width * shape.bytes_per_pixel);
  to.put_bytes(rows);
}

}  // namespace glint
