// write_known_samples FOLDER: writes a CAN log with every kind of frame that Glint sends, and the
// values of each as one JSON object a line. The reader of the log must not share code with its
// writer.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "kernels/wire/can_frames.hpp"
#include "kernels/wire/node_frames.hpp"
#include "platform/sinks/can/can_sink.hpp"
#include "tests/unit/kernels/wire/samples.hpp"

namespace {

using namespace glint;

constexpr int k_random_samples = 400;
constexpr std::int64_t k_unix_offset_ns = 1'700'000'000'000'000'000;

void print(std::FILE* file, const char* name, const Vector3& v) {
  std::fprintf(file, "\"%s\": [%.17g, %.17g, %.17g], ", name, v.x(), v.y(), v.z());
}

void print(std::FILE* file, const PoseSample& s) {
  std::fprintf(file, "{\"tool\": %d, \"tick\": %u, \"sequence\": %u, \"state\": %d, ", s.tool,
               static_cast<std::uint32_t>(s.tick_number),
               static_cast<std::uint32_t>(s.frame_sequence), static_cast<int>(s.state));
  std::fprintf(file, "\"registration\": %d, \"reason\": %d, \"marker_mask\": %d, \"buttons\": %d, ",
               static_cast<int>(s.registration), static_cast<int>(s.reason), s.marker_mask,
               s.buttons);
  print(file, "position_m", s.pose.translation);
  print(file, "velocity_m_s", s.velocity_m_s);
  print(file, "angular_velocity_rad_s", s.angular_velocity_rad_s);
  const Quaternion& q = s.pose.rotation;
  std::fprintf(file, "\"rotation_xyzw\": [%.17g, %.17g, %.17g, %.17g], ", q.x(), q.y(), q.z(),
               q.w());
  std::fprintf(file, "\"sigma_position_m\": %.17g, \"sigma_orientation_rad\": %.17g, ",
               s.sigma_position_m, s.sigma_orientation_rad);
  std::fprintf(file, "\"covariance\": [");
  for (int i = 0; i < 36; ++i) {
    std::fprintf(file, "%s%.17g", i == 0 ? "" : ", ", s.covariance(i / 6, i % 6));
  }
  std::fprintf(file, "], \"registration_rms_m\": %.17g, \"age_ns\": %lld, \"unix_ns\": %lld, ",
               s.registration_rms_m, static_cast<long long>(s.age().nanoseconds),
               static_cast<long long>(s.measurement.nanoseconds + k_unix_offset_ns));
}

Matrix6 random_covariance(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Matrix6 factor;
  for (int i = 0; i < 36; ++i) factor(i / 6, i % 6) = 0.01 * normal(random);
  return factor * factor.transpose();
}

// Beside the random samples: values at the end of a field's range and beyond it.
PoseSample edge_sample(int edge, std::mt19937& random) {
  PoseSample s = random_sample(random);
  if (edge == 0) s.pose.translation = Vector3(3.27675, -3.2768, 0);
  if (edge == 1) s.pose.translation = Vector3(3.4, 0, 0);
  if (edge == 2) s.velocity_m_s = Vector3(3.2767, -3.2767, 0);
  if (edge == 3) s.velocity_m_s = Vector3(0, 4, 0);
  if (edge == 4) s.angular_velocity_rad_s = Vector3(0, 0, -40);
  if (edge == 5) s.sigma_position_m = s.sigma_orientation_rad = s.registration_rms_m = 2;
  if (edge == 6) s.state = TrackState::lost;
  if (edge == 7) s.state = TrackState::none;
  if (edge == 8) s.pose.rotation = Quaternion(0.1, 0.2, -0.3, 0.9).normalized();
  return s;
}
constexpr int k_edges = 9;

constexpr std::array k_node_states{CanNodeState::boot_up, CanNodeState::pre_operational,
                                   CanNodeState::operational, CanNodeState::stopped};

// The values of the node's frames after the sample's, which cycle through all kinds.
struct NodeValues {
  CanNodeState state;
  OverrunEmergency overrun;
  std::uint8_t lost_output;
};

NodeValues node_values(int i) {
  return {k_node_states[static_cast<std::size_t>(i % 4)],
          {static_cast<std::uint8_t>(i % 2), static_cast<std::uint8_t>(1 + i / 2 % 2),
           static_cast<Reason>(static_cast<int>(Reason::overrun_skipped) + i % 4),
           static_cast<std::uint8_t>(i % 256)},
          static_cast<std::uint8_t>(1 + i % 3)};
}

void print(std::FILE* file, const NodeValues& v) {
  std::fprintf(file, "\"node_state\": %d, \"overrun\": [%d, %d, %d, %d], \"lost_output\": %d}\n",
               static_cast<int>(v.state), v.overrun.group, v.overrun.kind,
               static_cast<int>(v.overrun.reason), v.overrun.after_node, v.lost_output);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  CanSinkOptions options;
  options.directory = arguments[1];
  options.unix_offset_ns = k_unix_offset_ns;
  options.when_full = OverflowPolicy::wait;
  const auto sink = open_can_sink("log:can.log", options);
  std::FILE* const truth = std::fopen((options.directory / "samples.jsonl").c_str(), "w");
  if (truth == nullptr) return 2;

  std::mt19937 random(51);
  for (int i = 0; i < k_random_samples + k_edges; ++i) {
    PoseSample s =
        i < k_random_samples ? random_sample(random) : edge_sample(i - k_random_samples, random);
    s.reason = static_cast<Reason>(static_cast<std::size_t>(i) % k_reasons);
    s.covariance = random_covariance(random);
    if (i == k_random_samples) s.covariance(2, 2) = 1;  // a deviation of a metre: beyond its field
    if (is_overrun(s.reason)) s.state = TrackState::lost;  // a tool that an overrun stopped
    const NodeValues node = node_values(i);
    print(truth, s);
    print(truth, node);
    CanFrames frames;
    for (const CanFormat format : {CanFormat::classic, CanFormat::fd_covariance})
      add_pose_frames(s, {format, k_can_base_default, k_unix_offset_ns}, frames);
    frames.add(heartbeat_frame(32, node.state));
    frames.add(emergency_frame(32, s));
    frames.add(overrun_frame(32, node.overrun));
    frames.add(lost_output_frame(32, node.lost_output));
    const std::int64_t unix_ns = s.measurement.nanoseconds + k_unix_offset_ns;
    const auto counter = static_cast<std::uint8_t>(i % 16);
    frames.add(time_sync_frame({}, counter, unix_ns).value);
    frames.add(time_follow_up_frame({}, counter, unix_ns, unix_ns + 1'500'000'000).value);
    for (const CanFrame& frame : frames.frames()) sink->send(frame, s.tick);
  }
  std::fclose(truth);
  sink->flush();
  return sink->counts().all_sent() ? 0 : 1;
}
