// One run of the experiment `rates`: frames of a tool in a moving hand as they arrive, ticks at
// 250 Hz between them.
//
// The frames go two ways, with the same stamps. The graph: markers through MarkerTracker and the
// tick's PredictTools, whose samples state what a user sees. The motion filter: CheckFrame, a
// weighted fit of the markers, ToolMotion, and at each tick the integrated pose with the closed
// form's covariance. What is right is taken from the schedule alone: the newest frame that has
// arrived with a true stamp.
#pragma once

#include <array>
#include <cstdint>

#include "platform/experiments/consistency.hpp"
#include "platform/experiments/rates_schedule.hpp"

namespace glint {

struct GraphTally {
  std::int64_t ticks = 0, states_right = 0;
  std::int64_t age_error_most_ns = 0;  // stated age against that of the frame it rests on
  Consistency tip;                     // of the sample's pose, as it states its covariance
};

enum class Rate { fast, slow };

struct RatesTally {
  std::array<GraphTally, 2> graph;    // by Rate of the tick
  std::array<Consistency, 2> motion;  // of the middle of the markers
  std::int64_t accepted = 0, refused = 0;
  std::int64_t refused_changed = 0;  // refused frames after which an estimate was another one
  // Most frames, young enough to make it measured, that a tool not measured took to be so again.
  std::int64_t frames_to_measured = 0;
};

struct RatesRun {
  Mishaps mishaps;
  std::uint64_t seed = 1, run = 0;
};

void follow_rates(const RatesRun& run, RatesTally& tally);

}  // namespace glint
