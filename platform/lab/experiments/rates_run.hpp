// One run of the experiment `rates`: frames of a tool in a moving hand in order of arrival, with
// ticks at 250 Hz between them.
//
// Two chains process frames with the same time stamps. The graph: markers through MarkerTracker and
// the tick's PredictTools, whose samples are the user's output. The motion filter: CheckFrame, a
// weighted fit of the markers, ToolMotion, and at each tick the integrated pose with the
// closed-form covariance. The expected values come from the schedule alone: the newest frame that
// has arrived with a true time stamp.
#pragma once

#include <array>
#include <cstdint>

#include "platform/lab/experiments/consistency.hpp"
#include "platform/lab/experiments/rates_schedule.hpp"

namespace glint {

struct GraphTally {
  std::int64_t ticks = 0, states_correct = 0;
  std::int64_t age_error_max_ns = 0;  // stated age against that of the frame it is based on
  Consistency tip;                    // of the sample's pose, with its stated covariance

  void add(const GraphTally& other);
};

enum class Rate { fast, slow };

struct RatesTally {
  std::array<GraphTally, 2> graph;    // by Rate of the tick
  std::array<Consistency, 2> motion;  // of the markers' mean
  std::int64_t accepted = 0, rejected = 0;
  std::int64_t rejected_changed = 0;  // rejected frames that changed an estimate
  // Largest number of fresh frames until a tool that was not measured is measured again.
  std::int64_t frames_to_measured = 0;

  void add(const RatesTally& other);
};

struct RatesRun {
  FrameFaults faults;
  std::uint64_t seed = 1, run = 0;
};

[[nodiscard]] RatesTally follow_rates(const RatesRun& run);

}  // namespace glint
