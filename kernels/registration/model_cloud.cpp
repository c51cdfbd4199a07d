#include "kernels/registration/model_cloud.hpp"

namespace glint {

Reason pose_cloud(const LinkCloud& robot, const LinkPoses& poses, std::span<Vector3f> points,
                  std::span<Vector3f> normals) noexcept {
  const std::size_t count = robot.cloud.points.size();
  if (count > k_model_points_max || robot.cloud.normals.size() != count ||
      robot.links.size() != count || points.size() != count || normals.size() != count) {
    return Reason::out_of_range;
  }
  int link = -1;
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();
  Vector3f translation = Vector3f::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    if (robot.links[i] != link) {
      link = robot.links[i];
      if (link >= poses.count) return Reason::out_of_range;
      const Pose& pose = poses.T_root_link[static_cast<std::size_t>(link)];
      rotation = pose.rotation.toRotationMatrix().cast<float>();
      translation = pose.translation.cast<float>();
    }
    points[i] = rotation * robot.cloud.points[i] + translation;
    normals[i] = rotation * robot.cloud.normals[i];
  }
  return Reason::none;
}

}  // namespace glint
