// JSON summary of a companion computer's run, with the field names of a desktop summary.
#include "platform/apps/board/board_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace glint::board_json_test {
namespace {

TEST(BoardJson, SaysWhatWasHeardOverCan) {
  CompanionResult result;
  result.can_received = {3, 2};
  const auto heard = as_json(result).at("can_input");
  EXPECT_EQ(heard.at("buttons"), 3);
  EXPECT_EQ(heard.at("refused"), 2);
  EXPECT_EQ(heard.at("why_not"), "");
  result.can_receive_error = "can.buttons: no bus";
  EXPECT_EQ(as_json(result).at("can_input").at("why_not"), "can.buttons: no bus");
}

TEST(BoardJson, SaysByWhichJointsTheRobotWasFollowed) {
  CompanionResult result;
  EXPECT_FALSE(as_json(result).contains("background"));
  BackgroundCounts& counts = result.background.emplace();
  counts.joints_used = 5;
  counts.joints_skipped = 4;
  counts.images_without_joints = 6;
  const auto robot = as_json(result).at("background").at("references");
  EXPECT_EQ(robot.at("joint_states_used"), 5);
  EXPECT_EQ(robot.at("joint_states_passed_over"), 4);
  EXPECT_EQ(robot.at("pictures_without_joints"), 6);
}

}  // namespace
}  // namespace glint::board_json_test
