#include "platform/sim/placed_motion.hpp"

#include <utility>

namespace glint::sim {
namespace {

class PlacedMotion final : public Motion {
 public:
  PlacedMotion(Trajectory trajectory, const Placement& placement)
      : trajectory_(std::move(trajectory)), placement_(placement) {
    Vector3 low = trajectory_.samples.front().pose.translation, high = low;
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    const Eigen::Vector4d first = trajectory_.samples.front().pose.rotation.coeffs();
    for (const TimedPose& sample : trajectory_.samples) {
      low = low.cwiseMin(sample.pose.translation);
      high = high.cwiseMax(sample.pose.translation);
      const Eigen::Vector4d q = sample.pose.rotation.coeffs();
      sum += q.dot(first) < 0 ? Eigen::Vector4d(-q) : q;
    }
    middle_.translation = 0.5 * (low + high);
    middle_.rotation = sum.norm() > 1e-3 ? Quaternion(Eigen::Vector4d(sum.normalized()))
                                         : trajectory_.samples.front().pose.rotation;
  }

  [[nodiscard]] Pose pose(Time time) const override {
    const Pose here = interpolated(trajectory_, time);
    const Quaternion back = middle_.rotation.conjugate();
    const Vector3 move = back * (here.translation - middle_.translation);
    const Vector3 turn = rotation_vector((back * here.rotation).normalized());
    return placement_.anchor * Pose{from_rotation_vector(placement_.rotation_scale * turn),
                                    placement_.position_scale * move};
  }

 private:
  Trajectory trajectory_;
  Placement placement_;
  Pose middle_;
};

}  // namespace

MotionPointer placed_motion(Trajectory trajectory, const Placement& placement) {
  return std::make_shared<PlacedMotion>(std::move(trajectory), placement);
}

double scale_to_half_extent(const Trajectory& trajectory, double half_extent_m) {
  Vector3 low = trajectory.samples.front().pose.translation, high = low;
  for (const TimedPose& sample : trajectory.samples) {
    low = low.cwiseMin(sample.pose.translation);
    high = high.cwiseMax(sample.pose.translation);
  }
  const double half = 0.5 * (high - low).maxCoeff();
  return half > 0 ? half_extent_m / half : 1.0;
}

}  // namespace glint::sim
