#include "platform/sim/localisation.hpp"

#include <cmath>
#include <utility>

#include "kernels/elementary.hpp"
#include "kernels/motion/interpolate.hpp"
#include "platform/sim/random.hpp"

namespace glint::sim {
namespace {

constexpr double k_step_s = k_localisation_step.seconds();

// First-order Gauss-Markov process: stationary standard deviation 1, correlation exp(-dt / time)
// between steps.
struct GaussMarkov {
  RandomKey key;
  double decay = 0, innovation = 1;
  Vector3 value = Vector3::Zero();

  GaussMarkov(const RandomKey& random, double correlation_s) : key(random) {
    decay = correlation_s > 0 ? exponential(-k_step_s / correlation_s) : 0;
    innovation = std::sqrt(1 - decay * decay);
    value = gaussian_vector(key, 0);
  }
  void step(std::uint64_t index) {
    value = decay * value + innovation * gaussian_vector(key, index);
  }
};

}  // namespace

Localisation::Localisation(const LocalisationSettings& settings, MotionPointer camera,
                           Duration duration, std::uint64_t seed)
    : settings_(settings), camera_(std::move(camera)) {
  const auto key = [seed](std::uint64_t walk) {
    return RandomKey{seed, Stream::localisation, walk};
  };
  GaussMarkov rest_position(key(0), settings.rest_correlation_s);
  GaussMarkov rest_angle(key(1), settings.rest_correlation_s);
  GaussMarkov moving_position(key(2), settings.motion_correlation_s);
  GaussMarkov moving_angle(key(3), settings.motion_correlation_s);
  const double follow = settings.motion_correlation_s > 0
                            ? 1 - exponential(-k_step_s / settings.motion_correlation_s)
                            : 1;
  double speed = 0, turn = 0;
  const std::int64_t steps = duration.nanoseconds / k_localisation_step.nanoseconds + 2;
  TimedPose before{Time{}, camera_->pose(Time{})};
  for (std::int64_t i = 0; i < steps; ++i) {
    const auto index = static_cast<std::uint64_t>(i) + 1;
    const Time now{i * k_localisation_step.nanoseconds};
    const TimedPose here{now, camera_->pose(now)};
    const Velocity velocity = velocity_between(before, here);
    before = here;
    speed += follow * (velocity.linear_m_s.norm() - speed);
    turn += follow * (velocity.angular_rad_s.norm() - turn);
    rest_position.step(index);
    rest_angle.step(index);
    moving_position.step(index);
    moving_angle.step(index);
    const double position_scale =
        settings.position_per_speed_s * speed + settings.position_per_angular_speed_m * turn;
    const double angle_scale =
        settings.angle_per_speed_s_m * speed + settings.angle_per_angular_speed_s * turn;
    Error error;
    error.position = settings.rest_position_m * rest_position.value +
                     position_scale * (moving_position.value + settings.motion_position_bias);
    error.angle = settings.rest_angle_rad * rest_angle.value +
                  angle_scale * (moving_angle.value + settings.motion_angle_bias);
    errors_.push_back(error);
  }
}

Localisation::Error Localisation::error(Time time) const {
  const std::int64_t last = static_cast<std::int64_t>(errors_.size()) - 1;
  const std::int64_t step = k_localisation_step.nanoseconds;
  if (time.nanoseconds <= 0) return errors_.front();
  const std::int64_t cell = time.nanoseconds / step;
  if (cell >= last) return errors_.back();
  const double u = static_cast<double>(time.nanoseconds - cell * step) / static_cast<double>(step);
  const Error& a = errors_[static_cast<std::size_t>(cell)];
  const Error& b = errors_[static_cast<std::size_t>(cell) + 1];
  return {a.position + u * (b.position - a.position), a.angle + u * (b.angle - a.angle)};
}

Pose Localisation::pose(Time time) const {
  const Duration latency{static_cast<std::int64_t>(settings_.latency_s * 1e9)};
  const Pose truth = camera_->pose(time - latency);
  const Error now = error(time);
  const Quaternion turn = from_rotation_vector(now.angle);
  const Vector3 pivot = truth * Vector3(0, 0, settings_.pivot_m);
  const Pose drifted{(turn * truth.rotation).normalized(),
                     pivot + now.position + turn * (truth.translation - pivot)};
  return settings_.T_stated_world ? *settings_.T_stated_world * drifted : drifted;
}

Pose reference_pose(const ReferenceSettings& settings, const Pose& T_world_tool, std::uint64_t seed,
                    int tool, std::uint64_t index) {
  const RandomKey key{seed, Stream::reference, static_cast<std::uint64_t>(tool)};
  const Vector3 move = settings.position_sigma_m * gaussian_vector(key, 2 * index);
  const Vector3 turn = settings.angle_sigma_rad * gaussian_vector(key, 2 * index + 1);
  const Pose seen = settings.T_reference_world * T_world_tool;
  return {(from_rotation_vector(turn) * seen.rotation).normalized(), seen.translation + move};
}

}  // namespace glint::sim
