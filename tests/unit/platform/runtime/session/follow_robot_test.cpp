// A robot tracked during a session, and the replay of that session.
#include <gtest/gtest.h>

#include "platform/input_error.hpp"
#include "platform/runtime/session/replay.hpp"
#include "tests/unit/platform/runtime/session/followed_robot.hpp"
#include "tests/unit/platform/runtime/session/same_bytes.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"

namespace glint {
namespace {

struct FollowedRobot {
  TemporaryFolder folder;
  Cell cell;

  FollowedRobot(const char* level, double jump_m) : cell(short_cell(1.5, level)) {
    configure_box_robot(folder.path(), jump_m, cell);
  }
};

class RobotThatDrifts : public testing::TestWithParam<const char*> {};

TEST_P(RobotThatDrifts, IsFollowedAndReplaysAlike) {
  const FollowedRobot robot(GetParam(), 0);
  const TemporaryFolder plain;
  const SessionResult run = short_run(robot.cell, robot.folder.path());
  const SessionResult without = short_run(short_cell(1.5, GetParam()), plain.path());
  ASSERT_TRUE(run.background);
  EXPECT_GE(run.background->robot.followed, 8) << name_of(run.background->robot.last);
  EXPECT_EQ(run.background->robot.jumps, 0);
  EXPECT_EQ(run.background->robot.frame.state, RegistrationState::accepted);
  const double moved =
      (run.background->robot.frame.T_world_robot.translation - robot.cell.T_world_robot.translation)
          .norm();
  EXPECT_GT(moved, 2e-4);
  EXPECT_LT(moved, 6e-3);
  EXPECT_NE(run.output_sha256, without.output_sha256);
  for (const int workers : {1, 2}) {
    const ReplayResult result = expect_same_bytes(run.recording_file, run, workers);
    EXPECT_EQ(result.versions_missing, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(AtEveryLevel, RobotThatDrifts, testing::Values("full", "roi", "blobs"),
                         [](const auto& level) { return std::string(level.param); });

TEST(RobotThatJumps, IsRefusedAndStaysWhereItWas) {
  const FollowedRobot robot("roi", 0.03);
  const SessionResult run = short_run(robot.cell, robot.folder.path());
  ASSERT_TRUE(run.background);
  EXPECT_GE(run.background->robot.followed, 3);
  EXPECT_GE(run.background->robot.jumps, 3) << name_of(run.background->robot.last);
  EXPECT_NEAR(run.background->robot.translation_m, 0.03, 0.01);
  EXPECT_LT(
      (run.background->robot.frame.T_world_robot.translation - robot.cell.T_world_robot.translation)
          .norm(),
      6e-3);
  EXPECT_EQ(replay(run.recording_file, {}).output_sha256, run.output_sha256);
}

TEST(RobotThatIsFollowed, NeedsItsModelAndAsManyJoints) {
  FollowedRobot robot("roi", 0);
  robot.cell.mapping->joints = {0.1};
  EXPECT_THROW((void)short_run(robot.cell, robot.folder.path()), InputError);
  robot.cell.mapping->model = "nowhere.ply";
  EXPECT_THROW((void)short_run(robot.cell, robot.folder.path()), InputError);
}

}  // namespace
}  // namespace glint
