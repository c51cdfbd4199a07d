// How old what leaves on the bus may be, stage by stage.
//
// What:     frame to CAN: last byte in memory -> return of the write of the CAN frame that first
//           carries its estimate. Mid-exposure to bus: light -> last bit of that estimate's last
//           frame. Estimates published just after a tick has looked wait for the next: at most one
//           tick's gap, from which on the tick's response counts from its nominal release.
//             maximum reaction time = frame gap + latency: what happens just after an exposure;
//             maximum data age      = latency - sampling + frame gap: the last tick that sends an
//                                     estimate looks no later than the next one is published;
//             jitter                = latency - the least it can be (nodes that take no time,
//             frames
//                                     without stuff bits).
// Cost:     closed form on top of the responses.
// Accuracy: rows are bounds, estimates (the operating system's share) or declared (the camera's);
//           a total says how much of it is estimate. The gap is the camera's nominal one.
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

// What the camera declares.
struct SensorTimes {
  std::int64_t exposure_ns = 0;
  std::int64_t transport_ns = 0;  // end of exposure -> last byte in memory, at the earliest
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
  std::int64_t estimate_ns = 0;  // of the total
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
  std::int64_t system_ns = 0;  // interrupts, hand-overs, and writes of those that preempt
  std::int64_t writes_ns = 0;
};

struct ChainParts {
  SensorTimes sensor;
  std::int64_t arrival_jitter_ns = 0;
  std::int64_t frame_gap_ns = 0;
  std::int64_t tick_gap_ns = 0;
  SharedResponse frame, tick;
  std::int64_t first_write_ns = 0;     // of the tick's writes
  std::optional<std::int64_t> bus_ns;  // the slowest pose frame, from its queueing on
  std::int64_t bus_least_ns = 0;       // that frame without stuff bits on a free bus
  std::int64_t frame_to_can_deadline_ns = 0;
  std::int64_t age_deadline_ns = 0;  // from when on an estimate is worth nothing
};

// "frame_to_can", and "mid_exposure_to_bus" where the bus has a bound.
[[nodiscard]] std::vector<Chain> chains_of(const ChainParts& parts);

}  // namespace glint
