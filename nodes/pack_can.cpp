#include "nodes/pack_can.hpp"

#include <algorithm>

namespace glint {

// True once per period; periods missed by a skipped tick are not made up.
bool PackCan::due(Time tick, Duration period, Time& next) const noexcept {
  if (tick < next) return false;
  next = tick + period;
  return true;
}

// CiA 301, 7.3.2.2: a node boots up, is pre-operational, and then operational.
CanNodeState PackCan::state(Time tick, const PoseSamples& samples) const noexcept {
  if (!booted_) return CanNodeState::boot_up;
  const bool frames_come =
      samples.any_frame && tick - samples.newest_frame <= settings.frames_lost_after;
  return frames_come ? CanNodeState::operational : CanNodeState::pre_operational;
}

void PackCan::operator()(const Now& now, const PoseSamples& samples, CanFrames& frames) noexcept {
  frames.count = 0;
  frames.dropped = 0;
  const CanPacking packing{settings.format, settings.base_identifier, now.unix_offset_ns};
  const int count = std::min(samples.count, limits.tools);
  counts_ = {{1, settings.format == CanFormat::fd_covariance ? 2 * count : count}};
  for (int t = 0; t < count; ++t) {
    add_pose_frames(samples.items[static_cast<std::size_t>(t)], packing, frames);
  }

  if (due(now.tick, settings.heartbeat_period, next_heartbeat_)) {
    frames.add(heartbeat_frame(settings.node, state(now.tick, samples)));
    booted_ = true;
    ++counts_[graph::loop_of<PackCan>("node_frames")];
  }
  for (int t = 0; t < count; ++t) {
    const PoseSample& sample = samples.items[static_cast<std::size_t>(t)];
    TrackState& last = last_state_[static_cast<std::size_t>(t)];
    const bool lost_now = sample.state == TrackState::lost && last != TrackState::lost;
    const bool found_again = sample.has_pose() && last == TrackState::lost;
    if (lost_now || found_again) {
      frames.add(emergency_frame(settings.node, sample));
      ++counts_[graph::loop_of<PackCan>("emergencies")];
    }
    last = sample.state;
  }
  if (due(now.tick, settings.time_sync_period, next_time_sync_)) {
    const TimeSync sync{.base_identifier = settings.base_identifier};
    const std::int64_t unix_ns = now.tick.nanoseconds + now.unix_offset_ns;
    const auto begin = time_sync_frame(sync, time_sync_counter_, unix_ns);
    const auto follow_up = time_follow_up_frame(sync, time_sync_counter_, unix_ns, unix_ns);
    if (begin && follow_up) {
      frames.add(begin.value);
      frames.add(follow_up.value);
      counts_[graph::loop_of<PackCan>("node_frames")] += 2;
    }
    time_sync_counter_ = static_cast<std::uint8_t>((time_sync_counter_ + 1) % 16);
  }
}

}  // namespace glint
