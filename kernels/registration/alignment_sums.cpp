#include "kernels/registration/alignment_sums.hpp"

#include "kernels/elementary.hpp"

namespace glint {

Result<AlignmentStep> solve(const AlignmentSums& sums) noexcept {
  const Result<PoseFactor> factor = pose_factor(sums.matrix);
  if (!factor) return {{}, factor.reason};
  const Vector6 x = factor.value.solve(-sums.slope);
  return {{x.head<3>(), x.tail<3>()}, Reason::none};
}

Pose moved(const Pose& T, const AlignmentStep& step, const Vector3& centroid) noexcept {
  const double angle = step.rotation.norm();
  Quaternion rotation = Quaternion::Identity();
  if (angle > 0) {
    const SineCosine half = sine_cosine(0.5 * angle);
    const Vector3 v = step.rotation * (half.sine / angle);
    rotation = Quaternion(half.cosine, v.x(), v.y(), v.z());
  }
  return {(rotation * T.rotation).normalized(),
          rotation * (T.translation - centroid) + centroid + step.translation};
}

}  // namespace glint
