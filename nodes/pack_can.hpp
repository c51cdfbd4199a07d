// CAN frames of one tick: the pose of every tool, then the node's heartbeat, emergencies and time.
//
// Poses come first, because a controller waits for them. Heartbeat every 100 ms: the first one is
// the boot-up message, later ones are operational while the frame group publishes estimates. An
// emergency frame is sent when a tool is lost and when it is found again, CanTSyn once a second.
// The time in SYNC and follow-up is the tick's nominal release; it lags on the bus as much as the
// tick.
#pragma once

#include <array>
#include <string_view>

#include "graph/loops.hpp"
#include "kernels/limits.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/wire/can_frames.hpp"
#include "kernels/wire/can_messages.hpp"
#include "kernels/wire/node_frames.hpp"
#include "nodes/tokens.hpp"

namespace glint {

struct PackCanSettings {
  CanFormat format = CanFormat::classic;
  std::uint32_t base_identifier = k_can_base_default;
  unsigned node = 32;
  Duration heartbeat_period = milliseconds(can_message("Heartbeat").period_ms);
  Duration time_sync_period = milliseconds(can_message("TimeSync").period_ms);
  // Longest time without a new frame before the node is pre-operational (no camera, or a blocked
  // frame thread): 2.5 periods of 5 Hz, the slowest camera.
  Duration frames_lost_after = milliseconds(500);
};

// Worst input: every tool is found again with a pose, in a tick in which heartbeat and time are
// due.
struct PackCan {
  static constexpr std::array<std::string_view, 4> k_loops = {"call", "poses", "emergencies",
                                                              "node_frames"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    // A covariance counts as one more pose.
    return {{1, limits.tools + limits.covariance_frames, limits.tools, k_can_periodic_frames}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  PackCanSettings settings;
  Limits limits;
  void operator()(const Now& now, const PoseSamples& samples,
                  CanFrames& frames) noexcept GLINT_NONBLOCKING;

 private:
  [[nodiscard]] bool due(Time tick, Duration period, Time& next) const noexcept;
  [[nodiscard]] CanNodeState state(Time tick, const PoseSamples& samples) const noexcept;

  bool booted_ = false;
  Time next_heartbeat_;
  Time next_time_sync_;
  std::uint8_t time_sync_counter_ = 0;
  std::array<TrackState, k_tools_max> last_state_{};
  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<PackCan, Limits>);

}  // namespace glint
