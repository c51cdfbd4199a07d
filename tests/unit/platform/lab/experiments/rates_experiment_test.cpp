#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "platform/lab/experiments/motion_experiments.hpp"
#include "platform/lab/experiments/rates_run.hpp"
#include "platform/lab/experiments/rates_schedule.hpp"

namespace glint {
namespace {

std::vector<sim::FrameTiming> schedule(const FrameFaults& faults) {
  return rates_schedule(hololens2_ahat(), faults, 1);
}

TEST(RatesSchedule, FallsToFiveHertzAndComesBack) {
  const std::vector<sim::FrameTiming> frames = schedule({});
  int fast = 0, slow = 0;
  for (const sim::FrameTiming& frame : frames)
    ++(frame.exposed >= k_slow_from && frame.exposed < k_slow_until ? slow : fast);
  EXPECT_NEAR(slow, 25, 1);
  EXPECT_NEAR(fast, 450, 10);
}

TEST(RatesSchedule, GivesEachMishapItsPart) {
  const std::size_t all = schedule({}).size();
  FrameFaults faults;
  faults.dropped = 0.2;
  EXPECT_NEAR(static_cast<double>(schedule(faults).size()) / static_cast<double>(all), 0.8, 0.05);
  faults = {};
  faults.duplicated = 0.2;
  EXPECT_NEAR(static_cast<double>(schedule(faults).size()) / static_cast<double>(all), 1.2, 0.05);
  faults = {};
  faults.backward = 0.2;
  double backward = 0;
  for (const sim::FrameTiming& frame : schedule(faults)) {
    if (frame.mid_exposure != frame.exposed) ++backward;
  }
  EXPECT_NEAR(backward / static_cast<double>(all), 0.2, 0.05);
}

TEST(RatesSchedule, DeliversLateFramesBehindTheirSuccessors) {
  FrameFaults faults;
  faults.late = 0.2;
  const std::vector<sim::FrameTiming> frames = schedule(faults);
  int overtaken = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_LE(frames[i - 1].arrival, frames[i].arrival);
    overtaken += frames[i].exposed < frames[i - 1].exposed ? 1 : 0;
  }
  EXPECT_GT(overtaken, 40);
}

TEST(RatesSchedule, MovesExposuresWithTheirStamps) {
  FrameFaults faults;
  faults.exposure_jitter = milliseconds(3);
  const std::vector<sim::FrameTiming> frames = schedule(faults), steady = schedule({});
  ASSERT_EQ(frames.size(), steady.size());
  Duration most;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].exposed, frames[i].mid_exposure);
    most = std::max(most, frames[i].exposed - steady[i].exposed);
  }
  EXPECT_GT(most, milliseconds(2));
  EXPECT_LE(most, milliseconds(3));
}

TEST(RatesExperiment, TracksThroughEveryMishapInAQuickRun) {
  const CaseList list = run_rates({true, 1, ".", "", {}, 0, {}});
  EXPECT_EQ(missed_bars(list), 0) << case_table(list);
  // Checks that frames were refused at all.
  for (const ExperimentCase& one : list.cases) {
    if (one.name != "both, 10 % stamped backwards") continue;
    EXPECT_GT(one.figures.front().value, 50);
  }
}

}  // namespace
}  // namespace glint
