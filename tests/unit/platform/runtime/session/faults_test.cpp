// Late, duplicate, reordered or backward-stamped frames: counted, never `measured`.
#include "tests/unit/platform/runtime/session/short_run.hpp"

namespace glint {
namespace {

SessionResult with_fault(sim::Fault kind, Duration amount) {
  TemporaryFolder folder;
  const Cell cell = short_cell(1.0);
  sim::Scenario scenario = scenario_of(cell);
  for (int i = 0; i < 5; ++i) {
    scenario.timing.faults.push_back({kind, Time{} + milliseconds(200 + 100 * i), amount});
  }
  return short_run(cell, scenario, folder.path());
}

TEST(Faults, RefusesDoubledFrames) {
  const SessionResult result = with_fault(sim::Fault::doubled, milliseconds(5));
  EXPECT_EQ(result.accuracy.refused, 5);
  EXPECT_EQ(result.accuracy.gross, 0);
}

TEST(Faults, RefusesFramesThatComeAfterTheirSuccessors) {
  const SessionResult result = with_fault(sim::Fault::late, milliseconds(60));
  EXPECT_EQ(result.accuracy.refused, 5);
  EXPECT_EQ(result.accuracy.gross, 0);
}

TEST(Faults, RefusesBackwardStamps) {
  const SessionResult result = with_fault(sim::Fault::backward_stamp, milliseconds(500));
  EXPECT_EQ(result.accuracy.refused, 5);
  EXPECT_EQ(result.accuracy.gross, 0);
}

TEST(Faults, GoesOnAfterDroppedFrames) {
  const SessionResult result = with_fault(sim::Fault::dropped, Duration{});
  EXPECT_EQ(result.accuracy.refused, 0);
  EXPECT_GE(result.accuracy.tracked_fraction(), 0.97);
  EXPECT_EQ(result.accuracy.gross, 0);
}

TEST(Faults, TracksEveryFrameWithoutFaults) {
  TemporaryFolder folder;
  const SessionResult result = short_run(short_cell(1.0), folder.path());
  EXPECT_EQ(result.accuracy.refused, 0);
  EXPECT_EQ(result.accuracy.tracked, result.accuracy.trackable);
  EXPECT_GT(result.accuracy.trackable, 40);
  EXPECT_LT(result.accuracy.tip_rms_m, 0.006);
}

}  // namespace
}  // namespace glint
