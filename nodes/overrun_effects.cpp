#include "nodes/overrun_effects.hpp"

#include "kernels/motion/interpolate.hpp"

namespace glint {
namespace {

using graph::OverrunPolicy;

// A sample without a pose; tick, buttons and robot registration are kept.
PoseSample without_pose(const PoseSample& sample, TrackState state) {
  PoseSample bare;
  bare.tick = sample.tick;
  bare.tick_number = sample.tick_number;
  bare.tool = sample.tool;
  bare.buttons = sample.buttons;
  bare.measurement = sample.measurement;
  bare.frame_sequence = sample.frame_sequence;
  bare.registration = sample.registration;
  bare.registration_rms_m = sample.registration_rms_m;
  bare.state = state;
  bare.reason = sample.reason;
  return bare;
}

// Zeroes all derivatives: neither the next frame's prediction nor the tick group moves the tool.
void zero_velocity(Track& track) {
  track.has_previous = false;
  track.motion.velocity_m_s = track.motion.acceleration_m_s2 = Vector3::Zero();
  track.motion.angular_velocity_rad_s = track.motion.angular_acceleration_rad_s2 = Vector3::Zero();
}

void extrapolate_sample(Duration lead, PoseSample& sample) {
  const double seconds = lead.seconds();
  sample.pose.translation += sample.velocity_m_s * seconds;
  sample.pose.rotation =
      (from_rotation_vector(sample.angular_velocity_rad_s * seconds) * sample.pose.rotation)
          .normalized();
}

}  // namespace

bool substitute(OverrunPolicy policy, const OverrunFrame& frame, const Estimates& timely,
                Estimates& out) noexcept {
  if (policy == OverrunPolicy::skip_output) return false;
  const Reason reason = reason_of(policy);
  out = timely;
  out.verdict.stamp = frame.stamp;
  out.verdict.reason = reason;
  for (int t = 0; t < out.tool_count; ++t) {
    Track& track = out.tracks[static_cast<std::size_t>(t)];
    track.measured_now = false;
    if (policy == OverrunPolicy::stop_safe) {
      track = Track{};
      track.reason = reason;
      continue;
    }
    if (!track.alive) continue;
    track.reason = reason;
    if (policy == OverrunPolicy::hold_last) {
      zero_velocity(track);
    } else if (track.has_previous) {
      const Pose T_base_tool =
          extrapolate(track.previous, track.newest, frame.stamp.mid_exposure, frame.lost_after);
      if (track.base == ReferenceFrame::camera) {
        track.T_camera_tool = T_base_tool;
      } else if (frame.head.valid) {
        track.T_camera_tool = frame.head.T_world_camera.inverse() * T_base_tool;
      }
    }
  }
  return true;
}

bool substitute(OverrunPolicy policy, const OverrunTick& tick, const PoseSamples& timely,
                PoseSamples& out) noexcept {
  if (policy == OverrunPolicy::skip_output) return false;
  const Reason reason = reason_of(policy);
  out.count = timely.count;
  out.any_frame = timely.any_frame;
  out.newest_frame = timely.newest_frame;
  for (int t = 0; t < timely.count; ++t) {
    const auto i = static_cast<std::size_t>(t);
    PoseSample& sample = out.items[i];
    sample = timely.items[i];
    const Duration lead = tick.now.tick - sample.tick;
    sample.tick = tick.now.tick;
    sample.tick_number = tick.now.number;
    sample.buttons = tick.buttons.of_tool(sample.tool);
    if (policy == OverrunPolicy::stop_safe) {
      sample.reason = reason;
      sample = without_pose(sample, TrackState::lost);
      continue;
    }
    if (!sample.has_pose()) continue;
    if (sample.age() > tick.lost_after) {
      sample.reason = Reason::too_old;
      sample = without_pose(sample, TrackState::lost);
      continue;
    }
    sample.reason = reason;
    sample.state = TrackState::predicted;
    if (policy == OverrunPolicy::predict) extrapolate_sample(lead, sample);
  }
  return true;
}

}  // namespace glint
