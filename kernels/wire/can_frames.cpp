#include "kernels/wire/can_frames.hpp"

#include <bit>
#include <limits>

#include "kernels/wire/bits.hpp"
#include "kernels/wire/e2e.hpp"
#include "kernels/wire/quantize.hpp"
#include "kernels/wire/smallest_three.hpp"

namespace glint {
namespace {

constexpr std::int64_t k_position_max = 0xFFFF;  // 17-bit signed
constexpr std::int64_t k_word_max = 0x7FFF;      // 16-bit signed
constexpr std::int64_t k_long_max = 0x7FFFFFFF;
constexpr double k_one_rotation = 0x1p30;

std::uint64_t as_bits(std::int64_t value) { return static_cast<std::uint64_t>(value); }

std::uint64_t state_bits(TrackState state) { return static_cast<std::uint64_t>(state) & 3U; }

// Where the position has its valid bit, the other words of a pose have the state.
std::uint64_t state_at_end(TrackState state) { return state_bits(state) << 62; }

std::uint64_t marker_count(const PoseSample& sample) {
  return static_cast<std::uint64_t>(std::popcount(sample.marker_mask));
}

CanFrame classic(std::uint32_t identifier, std::uint64_t word, std::uint64_t tick_number) {
  CanFrame frame;
  frame.identifier = identifier;
  frame.length = 8;
  const std::span<std::uint8_t> bytes(frame.data.data(), 8);
  put_little_endian(bytes, word);
  // Modulo of all 64 bits: that of the low 32 bits would repeat a counter when they overflow.
  const auto counter = static_cast<unsigned>(tick_number % k_p01_counters);
  protect_p01(bytes, static_cast<std::uint16_t>(identifier), P01Mode::both, counter);
  return frame;
}

std::uint64_t three_words(const std::array<std::int64_t, 3>& value) {
  return bits_at(as_bits(value[0]), 14, 16) | bits_at(as_bits(value[1]), 30, 16) |
         bits_at(as_bits(value[2]), 46, 16);
}

std::uint64_t position_word(const PoseSample& sample) {
  const QuantizedVector p = quantize(sample.pose.translation, 1 / k_can_position_step_m,
                                     -k_position_max - 1, k_position_max);
  if (!sample.has_pose() || !p.fits) return 0;
  return bits_at(as_bits(p.value[0]), 12, 17) | bits_at(as_bits(p.value[1]), 29, 17) |
         bits_at(as_bits(p.value[2]), 46, 17) | std::uint64_t{1} << 63;
}

std::uint64_t orientation_word(const PoseSample& sample) {
  if (!sample.has_pose()) return state_at_end(sample.state);
  const SmallestThree q = to_smallest_three(sample.pose.rotation);
  if (!q.valid) return 0;
  return bits_at(q.left_out, 12, 2) |
         three_words({q.component[0], q.component[1], q.component[2]}) | state_at_end(sample.state);
}

std::uint64_t velocity_word(const PoseSample& sample, const Vector3& velocity, double step) {
  if (!sample.has_pose()) return state_at_end(sample.state);
  const QuantizedVector v = quantize(velocity, 1 / step, -k_word_max, k_word_max);
  if (!v.fits) return 0;
  return three_words(v.value) | state_at_end(sample.state);
}

// Quantises a value that is undefined without a pose; returns `over` then.
std::uint64_t known(const PoseSample& sample, double value, double step, std::uint64_t over) {
  return sample.has_pose() ? quantize_or(value, 1 / step, over) : over;
}

std::uint64_t quality_word(const PoseSample& s) {
  return bits_at(state_bits(s.state), 12, 3) |
         bits_at(static_cast<std::uint64_t>(s.registration), 15, 2) |
         bits_at(marker_count(s), 17, 4) |
         bits_at(known(s, s.sigma_position_m, k_can_sigma_position_step_m, k_can_sigma_over), 21,
                 10) |
         bits_at(
             known(s, s.sigma_orientation_rad, k_can_sigma_orientation_step_rad, k_can_sigma_over),
             31, 10) |
         bits_at(known(s, s.age().seconds(), k_can_age_step_s, k_can_age_over), 41, 11) |
         bits_at(quantize_or(s.registration_rms_m, 1 / k_can_rms_step_m, k_can_rms_over), 52, 7) |
         bits_at(s.buttons & k_buttons_mask, 59, 3);
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
  pose.position =
      quantize(s.pose.translation, 1 / k_can_fd_position_step_m, -k_long_max, k_long_max);
  pose.velocity = quantize(s.velocity_m_s, 1 / k_can_velocity_step_m_s, -k_word_max, k_word_max);
  pose.angular_velocity = quantize(s.angular_velocity_rad_s, 1 / k_can_angular_velocity_step_rad_s,
                                   -k_word_max, k_word_max);
  const Quaternion& q = s.pose.rotation;
  const std::array<double, 4> component{q.x(), q.y(), q.z(), q.w()};
  const bool fits = pose.position.fits && pose.velocity.fits && pose.angular_velocity.fits &&
                    to_smallest_three(q).valid;
  if (!fits) return {};
  for (std::size_t i = 0; i < 4; ++i)  // of a unit quaternion each component fits
    pose.rotation[i] = quantize(component[i], k_one_rotation, -k_long_max, k_long_max).value;
  return pose;
}

CanFrame fd(const PoseSample& s, std::uint32_t identifier, std::int64_t unix_offset_ns) {
  CanFrame frame;
  frame.identifier = identifier;
  frame.length = 64;
  frame.fd = true;
  frame.bit_rate_switch = true;
  const std::span<std::uint8_t> bytes(frame.data);
  std::size_t at = 3;
  const auto put = [&](std::uint64_t value, std::size_t size) {
    put_little_endian(bytes.subspan(at, size), value);
    at += size;
  };
  const FdPose pose = quantize_pose(s);
  put(state_bits(pose.state) | static_cast<std::uint64_t>(s.registration) << 3 |
          (s.buttons & k_buttons_mask) << 5,
      1);
  for (const std::int64_t p : pose.position.value) put(as_bits(p), 4);
  for (const std::int64_t r : pose.rotation) put(as_bits(r), 4);
  for (const std::int64_t v : pose.velocity.value) put(as_bits(v), 2);
  for (const std::int64_t w : pose.angular_velocity.value) put(as_bits(w), 2);
  put(known(s, s.sigma_position_m, k_can_sigma_position_step_m, k_can_fd_word_over), 2);
  put(known(s, s.sigma_orientation_rad, k_can_sigma_orientation_step_rad, k_can_fd_word_over), 2);
  put(known(s, s.age().seconds(), k_can_fd_age_step_s, k_can_fd_word_over), 2);
  put(marker_count(s), 1);
  put(quantize_or(s.registration_rms_m, 1 / k_can_rms_step_m, k_can_fd_byte_over), 1);
  put(unix_time(s.measurement, unix_offset_ns), 8);
  put(s.frame_sequence, 4);
  const auto counter = static_cast<unsigned>(s.tick_number % k_p05_counters);
  protect_p05(bytes, static_cast<std::uint16_t>(identifier), counter);
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
  if (packing.format == CanFormat::fd) {
    frames.add(fd(sample, base + k_can_fd_pose, packing.unix_offset_ns));
    return;
  }
  const auto add = [&](std::uint32_t offset, std::uint64_t word) {
    frames.add(classic(base + offset, word, sample.tick_number));
  };
  add(k_can_position, position_word(sample));
  add(k_can_orientation, orientation_word(sample));
  add(k_can_velocity, velocity_word(sample, sample.velocity_m_s, k_can_velocity_step_m_s));
  add(k_can_angular_velocity,
      velocity_word(sample, sample.angular_velocity_rad_s, k_can_angular_velocity_step_rad_s));
  add(k_can_quality, quality_word(sample));
}

}  // namespace glint
