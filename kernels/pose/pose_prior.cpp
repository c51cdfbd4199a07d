#include "kernels/pose/pose_prior.hpp"

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/lever_arm.hpp"

namespace glint {

void add_prior(const PosePrior& prior, const Pose& T_camera_tool, const Vector3& mean_m,
               NormalEquations& normal) noexcept {
  const Vector3 lever = T_camera_tool.rotation * (prior.reference_m - mean_m);
  const Vector3 away = T_camera_tool * prior.reference_m - prior.T_camera_tool * prior.reference_m;
  const Vector3 turned =
      rotation_vector(T_camera_tool.rotation * prior.T_camera_tool.rotation.conjugate());
  const Matrix3 turned_cross = cross_matrix(turned);
  Matrix6 change = pose_by_pose(lever);
  change.bottomRightCorner<3, 3>() =
      Matrix3::Identity() - 0.5 * turned_cross + turned_cross * turned_cross / 12.0;
  Vector6 miss;
  miss << away, turned;
  const Matrix6 weighted = change.transpose() * prior.information;
  normal.matrix += weighted * change;
  normal.gradient += weighted * miss;
  normal.chi_square += miss.dot(prior.information * miss);
}

}  // namespace glint
