// Serialisation of Glint's values as ROS messages; each starts a message in the writer. Time stamps
// are since 1970.
#pragma once

#include <string>
#include <string_view>

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"
#include "kernels/wire/pose_sample.hpp"
#include "platform/sinks/record/cdr.hpp"

namespace glint {

inline constexpr std::string_view k_camera_frame = "hmd_tof_optical";
inline constexpr std::string_view k_world_frame = "hmd_world";
inline constexpr std::string_view k_robot_frame = "robot_base";

[[nodiscard]] std::string_view frame_name(ReferenceFrame frame);

// builtin_interfaces/Time ends in 2038; times outside its range are clamped.
void put_header(CdrWriter& to, Time since_1970, std::string_view frame);
void put_vector(CdrWriter& to, const Vector3& vector);
void put_pose(CdrWriter& to, const Pose& pose);  // geometry_msgs/Pose

// Pose of the tool's tip, predicted to the tick.
void write_pose_stamped(CdrWriter& to, Time since_1970, const PoseSample& sample);
void write_pose_with_covariance(CdrWriter& to, Time since_1970, const PoseSample& sample);
// tf2_msgs/TFMessage of one transform.
void write_transform(CdrWriter& to, Time since_1970, std::string_view parent,
                     std::string_view child, const Pose& T_parent_child);

// sensor_msgs/Image with rows without padding; encoding "mono8", "mono16" or "16UC1".
struct ImageShape {
  std::uint32_t width = 0, height = 0, bytes_per_pixel = 0;
  std::string_view encoding;
};
void write_image(CdrWriter& to, Time since_1970, const ImageShape& shape,
                 std::span<const std::uint8_t> rows);

}  // namespace glint
