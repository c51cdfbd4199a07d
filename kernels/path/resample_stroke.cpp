#include "kernels/path/resample_stroke.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/motion/interpolate.hpp"

namespace glint {
namespace {

constexpr double k_no_crossing = 2;  // parameter beyond any segment
constexpr double k_rounding = 1e-6;  // far above the rounding error of a unit quaternion

bool is_positive_finite(double number) noexcept { return std::isfinite(number) && number > 0; }

double angle_between(const Quaternion& a, const Quaternion& b) noexcept {
  return rotation_vector(a.conjugate() * b).norm();
}

}  // namespace

Reason StrokeResampler::begin(const StrokeSettings& settings) noexcept {
  *this = {};
  const bool right = is_positive_finite(settings.spacing_m) &&
                     is_positive_finite(settings.turn_rad) &&
                     settings.turn_rad <= std::numbers::pi && settings.gap_max.nanoseconds > 0 &&
                     is_positive_finite(settings.acceleration_m_s2) &&
                     is_positive_finite(settings.angular_acceleration_rad_s2);
  settings_ = settings;
  return right ? Reason::none : Reason::out_of_range;
}

Reason StrokeResampler::add(const UncertainPose& sample_in) noexcept {
  const Pose& pose = sample_in.pose;
  if (!pose.translation.allFinite() || !pose.rotation.coeffs().allFinite() ||
      !sample_in.covariance.allFinite() || std::abs(pose.rotation.squaredNorm() - 1) > k_rounding) {
    return Reason::out_of_range;
  }
  if (count_ > 0) {
    const UncertainPose& last = sample(count_ - 1);
    if (sample_in.time <= last.time) return Reason::frame_late;
    if (sample_in.time - last.time > settings_.gap_max) return Reason::too_old;
    const double distance = (pose.translation - last.pose.translation).norm();
    if (distance > settings_.spacing_m * k_stroke_step_max) return Reason::out_of_range;
  }
  ring_[static_cast<std::size_t>(count_++ % k_ring)] = sample_in;
  return Reason::none;
}

const UncertainPose& StrokeResampler::sample(std::int64_t i) const noexcept {
  return ring_[static_cast<std::size_t>(i % k_ring)];
}

StrokeResampler::Neighbours StrokeResampler::neighbours_of(std::int64_t middle) const noexcept {
  const Pose& own = sample(middle).pose;
  const Time time = sample(middle).time;
  const std::int64_t most = std::min({std::int64_t{k_half}, middle, count_ - 1 - middle});
  std::int64_t half = 0;
  while (half < most && time - sample(middle - half - 1).time <= k_neighbour_time_max &&
         sample(middle + half + 1).time - time <= k_neighbour_time_max) {
    ++half;
  }
  if (half == 0) return {own.translation, own.rotation};
  Neighbours mean;
  Eigen::Vector4d turn = Eigen::Vector4d::Zero();
  for (std::int64_t i = middle - half; i <= middle + half; ++i) {
    if (i == middle) continue;
    const Pose& pose = sample(i).pose;
    mean.place += pose.translation;
    const double side = pose.rotation.dot(own.rotation) < 0 ? -1 : 1;
    turn += side * pose.rotation.coeffs();
  }
  mean.place /= static_cast<double>(2 * half);
  // Rotations of one hand within 20 ms are close: the sum of unit quaternions is far from zero.
  // Otherwise uses the sample's own rotation.
  const double length = turn.norm();
  mean.rotation = length > 1e-3 ? Quaternion(Eigen::Vector4d(turn / length)) : own.rotation;
  return mean;
}

// Segment parameter at which the distance or rotation from the last point reaches the spacing;
// k_no_crossing if it does not.
double StrokeResampler::crossing() const noexcept {
  double u = k_no_crossing;
  if ((to_.place - kept_.place).norm() >= settings_.spacing_m) {
    const Vector3 along = to_.place - from_.place, off = from_.place - kept_.place;
    const double a = along.squaredNorm(), b = off.dot(along);
    const double c = off.squaredNorm() - settings_.spacing_m * settings_.spacing_m;
    const double root = std::max(0.0, b * b - a * c);
    u = a > 0 ? (std::sqrt(root) - b) / a : k_no_crossing;
  }
  const double turned = angle_between(kept_.rotation, to_.rotation);
  if (turned >= settings_.turn_rad) {
    const double before =
        angle_between(kept_.rotation, slerp(from_.rotation, to_.rotation, processed_));
    const double more = turned - before;
    const double share = more > 0 ? (settings_.turn_rad - before) / more : 1;
    u = std::min(u, processed_ + (1 - processed_) * std::clamp(share, 0.0, 1.0));
  }
  return u == k_no_crossing ? u : std::clamp(u, processed_, 1.0);
}

UncertainPose StrokeResampler::between(double u) const noexcept {
  const UncertainPose& a = sample(middle_ - 1);
  const UncertainPose& b = sample(middle_);
  const Duration gap = b.time - a.time;
  UncertainPose point;
  point.time =
      a.time + Duration{static_cast<std::int64_t>(u * static_cast<double>(gap.nanoseconds) + 0.5)};
  point.pose.translation = constant_velocity(a.pose.translation, b.pose.translation, u);
  point.pose.rotation = slerp(a.pose.rotation, b.pose.rotation, u);
  point.covariance = (1 - u) * a.covariance + u * b.covariance;
  // Deviation from the chord at a constant acceleration a: a u (1 - u) t^2 / 2.
  const double deviation_s2 = 0.5 * u * (1 - u) * gap.seconds() * gap.seconds();
  for (int i = 0; i < 6; ++i) {
    const double off = deviation_s2 * (i < 3 ? settings_.acceleration_m_s2
                                             : settings_.angular_acceleration_rad_s2);
    point.covariance(i, i) += off * off;
  }
  return point;
}

StrokeResampler::Next StrokeResampler::next(UncertainPose& point) noexcept {
  for (int i = 0; i <= k_ring; ++i) {  // pending segments: at most the ring's capacity
    if (!segment_open_) {
      const bool available = middle_ + k_half < count_ || (ending_ && middle_ < count_);
      if (!available) return last_point(point);
      to_ = neighbours_of(middle_);
      processed_ = 0;
      if (middle_ == 0) {
        from_ = kept_ = to_;
        point = last_ = sample(middle_++);
        points_ = 1;
        return Next::point;
      }
      segment_open_ = true;
    }
    const double u = crossing();
    if (u <= 1) {
      point = last_ = between(u);
      processed_ = u;
      kept_ = {constant_velocity(from_.place, to_.place, u),
               slerp(from_.rotation, to_.rotation, u)};
      ++points_;
      return Next::point;
    }
    from_ = to_;
    segment_open_ = false;
    ++middle_;
  }
  return Next::none;
}

StrokeResampler::Next StrokeResampler::last_point(UncertainPose& point) noexcept {
  if (!ending_ || ended_ || count_ == 0) return Next::none;
  ended_ = true;
  const UncertainPose& end = sample(count_ - 1);
  if (end.time <= last_.time) return Next::none;
  point = end;
  const double distance = (end.pose.translation - last_.pose.translation).norm();
  const double turn = angle_between(end.pose.rotation, last_.pose.rotation);
  const bool near = distance < 0.5 * settings_.spacing_m && turn < 0.5 * settings_.turn_rad;
  if (!near) return Next::point;
  return points_ > 1 ? Next::replace_last : Next::none;
}

}  // namespace glint
