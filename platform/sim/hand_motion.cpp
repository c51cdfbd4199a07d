#include "platform/sim/hand_motion.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "kernels/elementary.hpp"
#include "kernels/motion/interpolate.hpp"
#include "platform/sim/random.hpp"

namespace glint::sim {
namespace {

constexpr std::size_t k_waves = 5;

// Three axes, each a sum of sines with amplitude inversely proportional to frequency, as for a
// hand.
class SumOfSines {
 public:
  SumOfSines(const RandomKey& key, double rms, double slowest_hz, double fastest_hz) {
    const double octaves = logarithm(fastest_hz / slowest_hz);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double power = 0;
      for (std::size_t i = 0; i < k_waves; ++i) {
        Wave& wave = waves_[axis][i];
        const std::uint64_t index = 2 * (axis * k_waves + i);
        const double place = (static_cast<double>(i) + uniform(key, index)) / double{k_waves};
        wave.radians_per_s = 2 * std::numbers::pi * slowest_hz * exponential(octaves * place);
        wave.phase = 2 * std::numbers::pi * uniform(key, index + 1);
        wave.amplitude = 1.0 / wave.radians_per_s;
        power += 0.5 * wave.amplitude * wave.amplitude;
      }
      const double scale = rms / std::sqrt(power);
      for (Wave& wave : waves_[axis]) wave.amplitude *= scale;
    }
  }

  [[nodiscard]] Vector3 at(double seconds) const {
    Vector3 sum = Vector3::Zero();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const Wave& wave : waves_[axis]) {
        const double angle = wave.radians_per_s * seconds + wave.phase;
        sum[static_cast<Eigen::Index>(axis)] += wave.amplitude * sine_cosine(angle).sine;
      }
    }
    return sum;
  }

 private:
  struct Wave {
    double amplitude = 0, radians_per_s = 1, phase = 0;
  };
  std::array<std::array<Wave, k_waves>, 3> waves_;
};

class HandMotion final : public Motion {
 public:
  HandMotion(const HandSettings& settings, std::uint64_t seed, std::uint64_t instance)
      : settings_(settings),
        strokes_({seed, Stream::hand, 2 * instance}, settings.stroke_rms_m, settings.slowest_hz,
                 settings.fastest_hz),
        turns_({seed, Stream::hand, 2 * instance + 1}, settings.rotation_rms_rad,
               settings.slowest_hz, settings.fastest_hz),
        tremor_({seed, Stream::tremor, 2 * instance}, settings.tremor_rms_m,
                0.8 * settings.tremor_hz, 1.2 * settings.tremor_hz),
        tremor_turns_({seed, Stream::tremor, 2 * instance + 1}, settings.tremor_rms_rad,
                      0.8 * settings.tremor_hz, 1.2 * settings.tremor_hz) {}

  [[nodiscard]] Pose pose(Time time) const override {
    const double t = Duration{time.nanoseconds}.seconds();
    const double moving = envelope(t);
    const Vector3 move = moving * strokes_.at(t) + tremor_.at(t);
    const Vector3 turn = moving * turns_.at(t) + tremor_turns_.at(t);
    const Pose& rest = settings_.T_world_tool;
    const Quaternion rotation = (from_rotation_vector(turn) * rest.rotation).normalized();
    const Vector3 grip = rest * settings_.grip_m + move;
    return {rotation, grip - rotation * settings_.grip_m};
  }

 private:
  // 0 at rest, 1 while drawing; a cycle begins and ends at rest.
  [[nodiscard]] double envelope(double t) const {
    const double since = t - settings_.begin_s;
    if (since <= 0 || settings_.rest_fraction >= 1) return 0;
    const double inside = since - settings_.cycle_s * std::floor(since / settings_.cycle_s);
    const double rest = settings_.cycle_s * settings_.rest_fraction;
    const double edge =
        0.25 * (settings_.cycle_s - rest) < 1.0 ? 0.25 * (settings_.cycle_s - rest) : 1.0;
    return smooth_step(inside, rest, edge) *
           (1.0 - smooth_step(inside, settings_.cycle_s - edge, edge));
  }

  HandSettings settings_;
  SumOfSines strokes_, turns_, tremor_, tremor_turns_;
};

class HeadMotion final : public Motion {
 public:
  HeadMotion(const HeadSettings& settings, std::uint64_t seed)
      : settings_(settings),
        sway_({seed, Stream::head, 0}, settings.sway_rms_m, settings.slowest_hz,
              settings.fastest_hz),
        gaze_({seed, Stream::head, 1}, settings.gaze_rms_rad, settings.slowest_hz,
              settings.fastest_hz) {}

  [[nodiscard]] Pose pose(Time time) const override {
    const double t = Duration{time.nanoseconds}.seconds();
    const double moving = smooth_step(t, settings_.begin_s, 2.0);
    const Pose looking = look_at(settings_.position_m + moving * sway_.at(t), settings_.target_m);
    const Vector3 turn = moving * gaze_.at(t);
    return {(looking.rotation * from_rotation_vector(turn)).normalized(), looking.translation};
  }

 private:
  HeadSettings settings_;
  SumOfSines sway_, gaze_;
};

}  // namespace

MotionPointer hand_motion(const HandSettings& settings, std::uint64_t seed,
                          std::uint64_t instance) {
  return std::make_shared<HandMotion>(settings, seed, instance);
}

MotionPointer head_motion(const HeadSettings& settings, std::uint64_t seed) {
  return std::make_shared<HeadMotion>(settings, seed);
}

Pose look_at(const Vector3& position, const Vector3& target) {
  const Vector3 ahead = (target - position).normalized();
  const Vector3 right = ahead.cross(Vector3::UnitZ()).normalized();
  Matrix3 axes;
  axes.col(0) = right;
  axes.col(1) = ahead.cross(right);
  axes.col(2) = ahead;
  return {Quaternion(axes).normalized(), position};
}

}  // namespace glint::sim
