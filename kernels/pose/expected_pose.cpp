#include "kernels/pose/expected_pose.hpp"

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/pose_factor.hpp"

namespace glint {

double mahalanobis_square(const PredictedPose& expected, const Pose& found,
                          const Matrix6& found_covariance,
                          const Vector3& found_reference_m) noexcept {
  const Vector3& reference = expected.reference_m;
  const Matrix6 both =
      expected.covariance +
      moved_covariance(found_covariance, found.rotation * (reference - found_reference_m));
  Vector6 apart;
  apart << found * reference - expected.T_camera_tool * reference,
      rotation_vector(found.rotation * expected.T_camera_tool.rotation.conjugate());
  const Result<PoseFactor> factor = pose_factor(both);
  return factor ? apart.dot(factor.value.solve(apart)) : k_mahalanobis_unknown;
}

}  // namespace glint
