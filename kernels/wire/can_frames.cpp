#include "kernels/wire/can_frames.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "kernels/wire/bits.hpp"
#include "kernels/wire/can_layout_check.hpp"
#include "kernels/wire/e2e.hpp"
#include "kernels/wire/quantize.hpp"
#include "kernels/wire/smallest_three.hpp"

namespace glint {

static_assert(
    is_consistent(k_can_messages),
    "two CAN messages or signals share a name, an identifier or bits, or exceed their frame");

namespace {

std::uint64_t as_bits(std::int64_t value) { return static_cast<std::uint64_t>(value); }

std::uint64_t state_bits(TrackState state) { return static_cast<std::uint64_t>(state) & 3U; }

// Every classic word but the position's ends with the state.
std::uint64_t state_at_end(TrackState state) {
  return bits_at(k_velocity_message.signal("State"), state_bits(state));
}

std::uint64_t marker_count(const PoseSample& sample) {
  return static_cast<std::uint64_t>(std::popcount(sample.marker_mask));
}

CanFrame classic(const CanMessageLayout& message, std::uint32_t base, std::uint64_t word,
                 std::uint64_t tick_number) {
  CanFrame frame = frame_of(message, base + message.offset);
  const std::span<std::uint8_t> bytes(frame.data.data(), 8);
  put_little_endian(bytes, word);
  // Modulo of all 64 bits: that of the low 32 bits would repeat a counter when they overflow.
  const auto counter = static_cast<unsigned>(tick_number % k_p01_counters);
  protect_p01(bytes, static_cast<std::uint16_t>(frame.identifier), P01Mode::both, counter);
  return frame;
}

using Axes = std::span<const CanSignal, 3>;

std::uint64_t axes_bits(Axes axes, const std::array<std::int64_t, 3>& value) {
  return bits_at(axes[0], as_bits(value[0])) | bits_at(axes[1], as_bits(value[1])) |
         bits_at(axes[2], as_bits(value[2]));
}

// The functions below are inlined so that a signal's step and limits become constants of the code:
// otherwise each call divides by the step.
[[gnu::always_inline]] inline QuantizedVector quantize_axes(const Vector3& vector,
                                                            const CanSignal& axis) {
  return quantize(vector, 1 / axis.step, axis.raw_min(), axis.raw_max());
}

std::uint64_t position_word(const PoseSample& sample) {
  constexpr Axes axes = k_position_message.signals_from<3>("X");
  const QuantizedVector p = quantize_axes(sample.pose.translation, axes[0]);
  if (!sample.has_pose() || !p.fits) return 0;
  return axes_bits(axes, p.value) | bits_at(k_position_message.signal("Valid"), 1);
}

std::uint64_t orientation_word(const PoseSample& sample) {
  if (!sample.has_pose()) return state_at_end(sample.state);
  const SmallestThree q = to_smallest_three(sample.pose.rotation);
  if (!q.valid) return 0;
  return bits_at(k_orientation_message.signal("LeftOut"), q.left_out) |
         axes_bits(k_orientation_message.signals_from<3>("Component0"),
                   {q.component[0], q.component[1], q.component[2]}) |
         state_at_end(sample.state);
}

// Linear and angular velocity differ in their step alone.
std::uint64_t velocity_word(const PoseSample& sample, const Vector3& velocity, double step) {
  constexpr Axes axes = k_velocity_message.signals_from<3>("X");
  constexpr Axes angular = k_angular_velocity_message.signals_from<3>("X");
  static_assert(axes[0].field == angular[0].field && axes[2].field == angular[2].field &&
                axes[0].limit == angular[0].limit);
  if (!sample.has_pose()) return state_at_end(sample.state);
  const QuantizedVector v = quantize(velocity, 1 / step, axes[0].raw_min(), axes[0].raw_max());
  if (!v.fits) return 0;
  return axes_bits(axes, v.value) | state_at_end(sample.state);
}

[[gnu::always_inline]] inline std::uint64_t saturated(double value, const CanSignal& signal) {
  return quantize_or(value, 1 / signal.step, signal.field.all_ones());
}

// Quantises a value that is undefined without a pose; returns all ones then.
[[gnu::always_inline]] inline std::uint64_t known(const PoseSample& sample, double value,
                                                  const CanSignal& signal) {
  return sample.has_pose() ? saturated(value, signal) : signal.field.all_ones();
}

std::uint64_t quality_word(const PoseSample& s) {
  constexpr const CanMessageLayout& m = k_quality_message;
  constexpr const CanSignal& sigma_position = m.signal("SigmaPosition");
  constexpr const CanSignal& sigma_orientation = m.signal("SigmaOrientation");
  constexpr const CanSignal& age = m.signal("Age");
  constexpr const CanSignal& rms = m.signal("RegistrationRms");
  return bits_at(m.signal("State"), state_bits(s.state)) |
         bits_at(m.signal("Registration"), static_cast<std::uint64_t>(s.registration)) |
         bits_at(m.signal("Markers"), marker_count(s)) |
         bits_at(sigma_position, known(s, s.sigma_position_m, sigma_position)) |
         bits_at(sigma_orientation, known(s, s.sigma_orientation_rad, sigma_orientation)) |
         bits_at(age, known(s, s.age().seconds(), age)) |
         bits_at(rms, saturated(s.registration_rms_m, rms)) |
         bits_at(m.signal("Buttons"), s.buttons & k_buttons_mask);
}

// Returns 0, "unknown", if the sum is before 1970 or exceeds an int64.
std::uint64_t unix_time(Time time, std::int64_t offset_ns) {
  const std::uint64_t sum = as_bits(time.nanoseconds) + as_bits(offset_ns);
  return sum <= as_bits(std::numeric_limits<std::int64_t>::max()) ? sum : 0;
}

struct FdPose {
  QuantizedVector position;
  std::array<std::int64_t, 4> rotation{};
  QuantizedVector velocity;
  QuantizedVector angular_velocity;
  TrackState state = TrackState::none;
};

// Quantises the pose; returns zeros with state none if any part does not fit.
FdPose quantize_pose(const PoseSample& s) {
  FdPose pose;
  pose.state = s.state;
  if (!s.has_pose()) return pose;
  constexpr const CanMessageLayout& m = k_fd_message;
  pose.position = quantize_axes(s.pose.translation, m.signal("X"));
  pose.velocity = quantize_axes(s.velocity_m_s, m.signal("VelocityX"));
  pose.angular_velocity = quantize_axes(s.angular_velocity_rad_s, m.signal("AngularVelocityX"));
  const Quaternion& q = s.pose.rotation;
  const std::array<double, 4> component{q.x(), q.y(), q.z(), q.w()};
  const bool fits = pose.position.fits && pose.velocity.fits && pose.angular_velocity.fits &&
                    to_smallest_three(q).valid;
  if (!fits) return {};
  constexpr const CanSignal& axis = m.signal("RotationX");
  for (std::size_t i = 0; i < 4; ++i)  // of a unit quaternion each component fits
    pose.rotation[i] = quantize(component[i], 1 / axis.step, axis.raw_min(), axis.raw_max()).value;
  return pose;
}

void put_axes(std::span<std::uint8_t> bytes, Axes axes, const std::array<std::int64_t, 3>& value) {
  put(bytes, axes[0], as_bits(value[0]));
  put(bytes, axes[1], as_bits(value[1]));
  put(bytes, axes[2], as_bits(value[2]));
}

CanFrame fd(const PoseSample& s, std::uint32_t base, std::int64_t unix_offset_ns) {
  constexpr const CanMessageLayout& m = k_fd_message;
  constexpr const CanSignal& sigma_position = m.signal("SigmaPosition");
  constexpr const CanSignal& sigma_orientation = m.signal("SigmaOrientation");
  constexpr const CanSignal& age = m.signal("Age");
  constexpr const CanSignal& rms = m.signal("RegistrationRms");
  CanFrame frame = frame_of(m, base + m.offset);
  const std::span<std::uint8_t> bytes(frame.data);
  const FdPose pose = quantize_pose(s);
  put(bytes, m.signal("State"), state_bits(pose.state));
  put(bytes, m.signal("Registration"), static_cast<std::uint64_t>(s.registration));
  put(bytes, m.signal("Buttons"), s.buttons & k_buttons_mask);
  put_axes(bytes, m.signals_from<3>("X"), pose.position.value);
  put(bytes, m.signal("RotationX"), as_bits(pose.rotation[0]));
  put(bytes, m.signal("RotationY"), as_bits(pose.rotation[1]));
  put(bytes, m.signal("RotationZ"), as_bits(pose.rotation[2]));
  put(bytes, m.signal("RotationW"), as_bits(pose.rotation[3]));
  put_axes(bytes, m.signals_from<3>("VelocityX"), pose.velocity.value);
  put_axes(bytes, m.signals_from<3>("AngularVelocityX"), pose.angular_velocity.value);
  put(bytes, sigma_position, known(s, s.sigma_position_m, sigma_position));
  put(bytes, sigma_orientation, known(s, s.sigma_orientation_rad, sigma_orientation));
  put(bytes, age, known(s, s.age().seconds(), age));
  put(bytes, m.signal("Markers"), marker_count(s));
  put(bytes, rms, saturated(s.registration_rms_m, rms));
  put(bytes, m.signal("MeasurementTime"), unix_time(s.measurement, unix_offset_ns));
  put(bytes, m.signal("FrameSequence"), s.frame_sequence);
  const auto counter = static_cast<unsigned>(s.tick_number % k_p05_counters);
  protect_p05(bytes, static_cast<std::uint16_t>(frame.identifier), counter);
  return frame;
}

CanFrame covariance_fd(const PoseSample& s, std::uint32_t base) {
  constexpr const CanMessageLayout& m = k_covariance_message;
  constexpr auto sigmas = m.signals_from<can_table::k_pose_axes>(can_table::k_covariance_sigmas[0]);
  constexpr auto correlations =
      m.signals_from<can_table::k_correlations.size()>(can_table::k_correlations[0]);
  CanFrame frame = frame_of(m, base + m.offset);
  const std::span<std::uint8_t> bytes(frame.data.data(), frame.length);
  put(bytes, m.signal("State"), state_bits(s.state));
  std::array<double, can_table::k_pose_axes> sigma{};
  for (std::size_t i = 0; i < sigma.size() && s.has_pose(); ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    sigma[i] = std::sqrt(s.covariance(axis, axis));  // NaN of a negative one: unknown
    put(bytes, sigmas[i], saturated(sigma[i], sigmas[i]));
  }
  std::size_t at = 0;
  for (std::size_t i = 0; i < sigma.size() && s.has_pose(); ++i) {
    for (std::size_t j = i + 1; j < sigma.size(); ++j, ++at) {
      const double covariance =
          s.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      const CanSignal& signal = correlations[at];
      const double product = sigma[i] * sigma[j];
      const double correlation = product > 0 ? std::clamp(covariance / product, -1.0, 1.0) : 0;
      put(bytes, signal,
          as_bits(
              quantize(correlation, 1 / signal.step, signal.raw_min(), signal.raw_max()).value));
    }
  }
  const auto counter = static_cast<unsigned>(s.tick_number % k_p05_counters);
  protect_p05(bytes, static_cast<std::uint16_t>(frame.identifier), counter);
  return frame;
}

}  // namespace

void add_pose_frames(const PoseSample& sample, const CanPacking& packing,
                     CanFrames& frames) noexcept {
  if (sample.tool >= k_tools_max) {
    ++frames.dropped;
    return;
  }
  const std::uint32_t base = packing.base_identifier + k_can_tool_stride * sample.tool;
  if (is_fd(packing.format)) {
    frames.add(fd(sample, base, packing.unix_offset_ns));
    if (packing.format == CanFormat::fd_covariance) frames.add(covariance_fd(sample, base));
    return;
  }
  const auto add = [&](const CanMessageLayout& message, std::uint64_t word) {
    frames.add(classic(message, base, word, sample.tick_number));
  };
  add(k_position_message, position_word(sample));
  add(k_orientation_message, orientation_word(sample));
  add(k_velocity_message,
      velocity_word(sample, sample.velocity_m_s, k_velocity_message.signal("X").step));
  add(k_angular_velocity_message, velocity_word(sample, sample.angular_velocity_rad_s,
                                                k_angular_velocity_message.signal("X").step));
  add(k_quality_message, quality_word(sample));
}

}  // namespace glint
