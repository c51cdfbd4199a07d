// End-to-end latency of cause-effect chains, stage by stage: data age and reaction time.
//
// What:     Frame to CAN: from the last byte in memory to the return of the write of the first CAN
//           frame with its estimate. Mid-exposure to bus: from light to the last bit of that
//           estimate's last frame. Estimates published just after a tick has read its input wait
//           for the next tick: at most one tick gap. From there the tick's response counts from its
//           nominal release.
//             maximum reaction time = frame gap + latency: for an event just after an exposure;
//             maximum data age      = latency - sampling + frame gap: the last tick that sends an
//                                     estimate reads it before the next one is published;
//             jitter                = latency - minimum latency (nodes of zero time, frames
//                                     without stuff bits).
// Cost:     closed form on top of the responses.
// Accuracy: a stage is a bound, an estimate (the operating system's share) or declared (by the
//           camera); a total states its estimated part. The gap is the camera's nominal one.
// Source:   Feiertag, Richter, Nordlander, Jonsson 2008 ("first to first" and "last to last").
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "schedules/can_response.hpp"
#include "schedules/group_response.hpp"
#include "schedules/task_model.hpp"

namespace glint {

// Declared by the camera.
struct SensorTimes {
  std::int64_t exposure_ns = 0;
  std::int64_t transport_ns = 0;  // minimum from end of exposure to last byte in memory
};

enum class StageKind : std::uint8_t { bound, estimate, declared };
[[nodiscard]] const char* name_of(StageKind kind);

struct ChainStage {
  std::string name;
  StageKind kind = StageKind::bound;
  std::int64_t ns = 0;
};

struct Chain {
  std::string name;
  std::vector<ChainStage> stages;
  std::int64_t total_ns = 0;
  std::int64_t estimate_ns = 0;  // part of total_ns
  std::int64_t deadline_ns = 0;
  std::int64_t maximum_reaction_time_ns = 0;
  std::int64_t maximum_data_age_ns = 0;
  std::int64_t jitter_ns = 0;
};

// One group's response with and without the operating system's share.
struct SharedResponse {
  std::int64_t bound_ns = 0;     // nodes and preemption; without jitter and blocking
  std::int64_t blocking_ns = 0;  // by a slice of a resumable group on the same core
  std::int64_t wake_up_ns = 0;
  std::int64_t system_ns = 0;  // interrupts, inter-core delays, writes of preempting groups
  std::int64_t writes_ns = 0;
};

struct ChainParts {
  SensorTimes sensor;
  std::int64_t arrival_jitter_ns = 0;
  std::int64_t frame_gap_ns = 0;
  std::int64_t tick_gap_ns = 0;
  SharedResponse frame, tick;
  std::int64_t first_write_ns = 0;     // of the tick's writes
  std::optional<std::int64_t> bus_ns;  // worst case of a pose frame from its queueing
  std::int64_t bus_min_ns = 0;         // that frame without stuff bits on an idle bus
  std::int64_t frame_to_can_deadline_ns = 0;
  std::int64_t age_deadline_ns = 0;  // largest useful age of an estimate
};

// Returns "frame_to_can", and "mid_exposure_to_bus" if the bus has a bound.
[[nodiscard]] std::vector<Chain> chains_of(const ChainParts& parts);

}  // namespace glint
