#include <cmath>
#include <utility>

#include "platform/sim/trajectory.hpp"

namespace glint::sim {
namespace {

constexpr Duration k_gap = milliseconds(100);

// Time within the recording: forth, then back, then forth again.
Time mirrored(Time time, Duration length) {
  const std::int64_t period = 2 * length.nanoseconds;
  std::int64_t inside = time.nanoseconds % period;
  if (inside < 0) inside += period;
  return Time{inside <= length.nanoseconds ? inside : period - inside};
}

// Slope at `here` of the parabola through three samples.
Vector3 slope(const StampedPose& before, const StampedPose& here, const StampedPose& after) {
  const double left = (here.time - before.time).seconds();
  const double right = (after.time - here.time).seconds();
  const Vector3 first = (here.pose.translation - before.pose.translation) / left;
  const Vector3 second = (after.pose.translation - here.pose.translation) / right;
  return (right * first + left * second) / (left + right);
}

class PlacedMotion final : public Motion {
 public:
  PlacedMotion(Trajectory trajectory, const Placement& placement)
      : trajectory_(std::move(trajectory)), placement_(placement) {
    Vector3 low = trajectory_.samples.front().pose.translation, high = low;
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    const Eigen::Vector4d first = trajectory_.samples.front().pose.rotation.coeffs();
    for (const StampedPose& sample : trajectory_.samples) {
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

Pose interpolated(const Trajectory& trajectory, Time time) {
  const std::vector<StampedPose>& samples = trajectory.samples;
  const Time inside = mirrored(time, trajectory.length());
  std::size_t low = 0, high = samples.size() - 1;  // samples[low] <= inside <= samples[high]
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (samples[middle].time <= inside ? low : high) = middle;
  }
  const StampedPose& a = samples[low];
  const StampedPose& b = samples[high];
  const Duration span = b.time - a.time;
  Pose pose = interpolate(a, b, inside);
  if (span > k_gap || low == 0 || high + 1 == samples.size()) return pose;
  // Cubic Hermite with the neighbours' slopes.
  const double h = span.seconds();
  const double u = (inside - a.time).seconds() / h;
  const Vector3 out = h * slope(samples[low - 1], a, b);
  const Vector3 in = h * slope(a, b, samples[high + 1]);
  const Vector3 whole = b.pose.translation - a.pose.translation;
  pose.translation = a.pose.translation +
                     u * (out + u * ((3 * whole - 2 * out - in) + u * (out + in - 2 * whole)));
  return pose;
}

MotionPointer placed_motion(Trajectory trajectory, const Placement& placement) {
  return std::make_shared<PlacedMotion>(std::move(trajectory), placement);
}

double scale_to_half_extent(const Trajectory& trajectory, double half_extent_m) {
  Vector3 low = trajectory.samples.front().pose.translation, high = low;
  for (const StampedPose& sample : trajectory.samples) {
    low = low.cwiseMin(sample.pose.translation);
    high = high.cwiseMax(sample.pose.translation);
  }
  const double half = 0.5 * (high - low).maxCoeff();
  return half > 0 ? half_extent_m / half : 1.0;
}

}  // namespace glint::sim
