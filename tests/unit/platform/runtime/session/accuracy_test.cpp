#include "platform/runtime/session/accuracy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "kernels/angles.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"

namespace glint {
namespace {

struct FramesSeen {
  std::vector<FrameOutcome> outcomes;
  std::vector<FrameGroundTruth> ground_truths;

  ToolOutcome& frame(std::int64_t ms, std::uint8_t visible, bool seen, double error_m = 0) {
    FrameGroundTruth truth;
    truth.mid_exposure = Time{} + milliseconds(ms);
    truth.T_world_tool = {Pose{}};
    truth.visible_mask = {visible};
    ground_truths.push_back(std::move(truth));
    FrameOutcome outcome;
    outcome.tools[0].seen = seen;
    outcome.tools[0].T_camera_tool.translation.x() = error_m;
    outcomes.push_back(outcome);
    return outcomes.back().tools[0];
  }
  [[nodiscard]] Accuracy judged() const {
    ToolSet tools;
    tools.count = 1;
    return evaluate(outcomes, ground_truths, tools);
  }
};

TEST(Accuracy, CountsTrackableFramesFromTruthAlone) {
  FramesSeen run;
  run.frame(0, 0b0111, false);  // never tracked before
  run.frame(100, 0b1111, true);
  run.frame(1000, 0b10101, false);  // long after the tracked frame
  run.frame(1020, 0b0011, true);    // tracked, but not trackable
  EXPECT_EQ(run.judged().trackable, 3);
  EXPECT_EQ(run.judged().tracked, 1);
  EXPECT_EQ(run.judged().poses, 2);
}

TEST(Accuracy, IsTheRootMeanSquareOfTheTipsDistance) {
  FramesSeen run;
  run.frame(0, 0b1111, true, 0.003);
  run.frame(20, 0b1111, true, -0.004);
  EXPECT_NEAR(run.judged().tip_rms_m, std::sqrt((9e-6 + 16e-6) / 2), 1e-12);
}

TEST(Accuracy, CallsAPoseGrossByItsErrorNotByItsMarkers) {
  FramesSeen run;
  run.frame(0, 0, true);
  run.frame(20, 0b0001, true, 0.019);
  EXPECT_EQ(run.judged().gross, 0);
  run.frame(40, 0b1111, true, 0.021);
  EXPECT_EQ(run.judged().gross, 1);
}

TEST(Accuracy, CountsARefusedFrameAsTrackable) {
  FramesSeen run;
  run.frame(0, 0b1111, true);
  run.outcomes[0].verdict = Reason::frame_late;
  run.outcomes[0].tools[0].seen = false;
  EXPECT_EQ(run.judged().refused, 1);
  EXPECT_EQ(run.judged().trackable, 1);
  EXPECT_EQ(run.judged().tracked, 0);
}

TEST(Accuracy, CountsADoubledFrameOnce) {
  FramesSeen run;
  run.frame(0, 0b1111, true);
  run.frame(0, 0b1111, false);
  run.outcomes[1].verdict = Reason::frame_duplicate;
  EXPECT_EQ(run.judged().refused, 1);
  EXPECT_EQ(run.judged().trackable, 1);
  EXPECT_EQ(run.judged().tracked, 1);
}

TEST(Accuracy, LeavesOutAToolOnlyWhileItIsTakenOut) {
  FramesSeen run;
  run.frame(0, 0b1111, false).present = false;
  run.frame(20, 0b1111, false).present = false;  // the substitute of an overrun has no pose
  run.outcomes[1].verdict = Reason::overrun_stopped;
  run.frame(40, 0b1111, true);
  run.frame(60, 0b1111, false).present = false;
  run.outcomes[3].verdict = Reason::overrun_stopped;
  EXPECT_EQ(run.judged().trackable, 2);
  EXPECT_EQ(run.judged().refused, 0);
}

TEST(GrossPose, HasALargeTurnOrATipBeyondBothLimits) {
  const double deg = k_radians_per_degree;
  EXPECT_FALSE(is_gross({0, 14.9 * deg, 0, false}));
  EXPECT_TRUE(is_gross({0, 15.1 * deg, 0, false}));
  EXPECT_FALSE(is_gross({0.0199, 0, 0, false}));
  EXPECT_TRUE(is_gross({0.0201, 0, 0.0066, false}));
  EXPECT_FALSE(is_gross({0.0201, 0, 0.0068, false}));
  EXPECT_FALSE(is_gross({0.0049, 0, 0, true}));
  EXPECT_TRUE(is_gross({0.0051, 0, 1, true}));
}

// One marker of radius 5 mm at 0.5 m: its blob may be off by less than the marker's diameter.
TEST(GrossPose, IsMisassignedWhereABlobLiesADiameterBesideItsMarker) {
  Tool tool;
  tool.marker_count = 2;
  tool.marker_radius_m = 0.005;
  tool.markers_m[1] = Vector3(0.05, 0, 0.5);
  ToolOutcome outcome;
  outcome.blobs[1] = {0.1F + 0.019F, 0};
  EXPECT_FALSE(error_of(outcome, tool, {}).misassigned);  // no assignment stated
  outcome.blob_mask = 0b10;
  EXPECT_FALSE(error_of(outcome, tool, {}).misassigned);
  outcome.blobs[1].x += 0.002F;
  EXPECT_TRUE(error_of(outcome, tool, {}).misassigned);
  outcome.blobs[1].x = 0.1F - 0.021F;
  EXPECT_TRUE(error_of(outcome, tool, {}).misassigned);
}

// A lens error shifts all blobs equally; a wrong assignment shifts one relative to the others.
TEST(GrossPose, IsNotMisassignedWhereAllBlobsLieBesideTheirMarkersAlike) {
  Tool tool;
  tool.marker_count = 4;
  tool.marker_radius_m = 0.005;
  ToolOutcome outcome;
  for (int m = 0; m < 4; ++m) {
    const auto i = static_cast<std::size_t>(m);
    tool.markers_m[i] = Vector3(0.04 * m, 0, 0.5);
    outcome.blobs[i] = {0.08F * static_cast<float>(m) + 0.03F, 0};
  }
  outcome.blob_mask = 0b1111;
  EXPECT_FALSE(error_of(outcome, tool, {}).misassigned);
  outcome.blobs[2].y = 0.04F;
  EXPECT_TRUE(error_of(outcome, tool, {}).misassigned);
  outcome.blobs[2].y = 0;
  std::swap(outcome.blobs[0], outcome.blobs[1]);
  EXPECT_TRUE(error_of(outcome, tool, {}).misassigned);
}

TEST(Accuracy, ReadsTheTipsSigmaAndTheAssignmentOfEachPose) {
  const TemporaryFolder folder;
  const SessionResult run = short_run(short_cell(0.5), folder.path());
  ASSERT_GT(run.accuracy.poses, 15);
  for (const FrameOutcome& frame : run.outcomes) {
    const ToolOutcome& pen = frame.tools[0];
    if (!pen.seen) continue;
    EXPECT_GT(pen.tip_sigma_m, 1e-4);
    EXPECT_LT(pen.tip_sigma_m, 0.02);
    EXPECT_EQ(pen.blob_mask, pen.marker_mask);
  }
  EXPECT_EQ(run.accuracy.gross, 0);
}

}  // namespace
}  // namespace glint
