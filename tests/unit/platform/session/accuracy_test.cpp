#include "platform/session/accuracy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace glint {
namespace {

struct FramesSeen {
  std::vector<FrameOutcome> outcomes;
  std::vector<sim::SimTruth> truths;

  void frame(std::int64_t ms, std::uint8_t visible, bool seen, double error_m = 0) {
    sim::SimTruth truth;
    truth.mid_exposure = Time{} + milliseconds(ms);
    truth.T_world_tool = {Pose{}};
    truth.visible_mask = {visible};
    truths.push_back(std::move(truth));
    FrameOutcome outcome;
    outcome.tools[0].seen = seen;
    outcome.tools[0].T_camera_tool.translation.x() = error_m;
    outcomes.push_back(outcome);
  }
  [[nodiscard]] Accuracy judged() const {
    ToolSet tools;
    tools.count = 1;
    return judge(outcomes, truths, tools, milliseconds(250));
  }
};

TEST(Accuracy, CountsThreeMarkersOnlyShortlyAfterATrackedFrame) {
  FramesSeen run;
  run.frame(0, 0b0111, false);  // never tracked before: not trackable
  run.frame(100, 0b1111, true);
  run.frame(200, 0b0111, false);  // trackable, missed
  run.frame(400, 0b0111, false);  // 300 ms after the tracked frame: not trackable
  EXPECT_EQ(run.judged().trackable, 2);
  EXPECT_EQ(run.judged().tracked, 1);
}

TEST(Accuracy, IsTheRootMeanSquareOfTheTipsDistance) {
  FramesSeen run;
  run.frame(0, 0b1111, true, 0.003);
  run.frame(20, 0b1111, true, -0.004);
  EXPECT_NEAR(run.judged().tip_rms_m, std::sqrt((9e-6 + 16e-6) / 2), 1e-12);
}

TEST(Accuracy, CallsAPoseWithoutAToolGross) {
  FramesSeen run;
  run.frame(0, 0, true);
  run.frame(20, 0b1111, true, 0.021);
  run.frame(40, 0b1111, true, 0.019);
  EXPECT_EQ(run.judged().gross, 2);
}

TEST(Accuracy, LeavesRefusedFramesOut) {
  FramesSeen run;
  run.frame(0, 0b1111, true);
  run.outcomes[0].verdict = Reason::frame_late;
  EXPECT_EQ(run.judged().refused, 1);
  EXPECT_EQ(run.judged().poses, 0);
}

}  // namespace
}  // namespace glint
