#include "nodes/tokens.hpp"

#include "kernels/pose/lever_arm.hpp"

namespace glint {

Matrix3 Prediction::marker_position_covariance(const Vector3& from_centroid_m) const noexcept {
  const Eigen::Matrix<double, 3, 6> j = point_by_pose(T_camera_tool.rotation * from_centroid_m);
  return j * covariance * j.transpose();
}

UncertainPose centroid_pose_of(const FittedTool& found, const Tool& tool, Time time) noexcept {
  const Pose& seen = found.T_camera_tool;
  const Vector3 middle = tool.middle_m();
  return {time,
          {seen.rotation, seen * middle},
          moved_covariance(found.covariance, seen.rotation * (middle - tool.tip_m))};
}

UncertainPose filter_measurement_of(const FittedTool& found, const Tool& tool, Time time) noexcept {
  if (!found.has_relinearised) return centroid_pose_of(found, tool, time);
  const Pose& near = found.relinearised_T_camera_tool;
  return {time, {near.rotation, near * tool.middle_m()}, found.relinearised_covariance};
}

Matrix6 TipPosition::systematic_of(const Matrix6& of_middle,
                                   const Quaternion& axes_rotation) const noexcept {
  Matrix6 covariance = moved_covariance(of_middle, axes_rotation * arm_m);
  covariance.diagonal().head<3>().array() += sigma_m * sigma_m;
  return covariance;
}

}  // namespace glint
