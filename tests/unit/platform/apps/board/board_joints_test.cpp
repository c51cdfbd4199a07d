// Rate groups of a companion computer with a tracked robot. The test acts as the robot's driver.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "platform/apps/board/board_json.hpp"
#include "platform/apps/board/board_run.hpp"
#include "platform/runtime/rt/clock.hpp"
#include "platform/runtime/session/session_groups.hpp"
#include "tests/unit/platform/runtime/session/box_on_a_slide.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/robot_speaker.hpp"
#include "tests/unit/platform/tools/robot/files.hpp"

namespace glint {
namespace {

Time at_ms(std::int64_t number) { return Time{} + milliseconds(number); }

class HeardJointsOfABoard : public DdsTest {
 protected:
  HeardJointsOfABoard() {
    cell_.record.file.clear();
    cell_.files = {"", ""};
    cell_.realtime = true;
    cell_.dds.allow.add(DdsInput::joint_states);
    configure_sliding_box(files_.folder(), cell_);
    cell_.mapping->joints_lost_after = milliseconds(600'000);  // also on a slow machine
  }

  const test::Files files_;
  Cell cell_ = default_cell();
};

TEST_F(HeardJointsOfABoard, LetItFollowWhatItCannotFollowWithoutThem) {
  const Time epoch = monotonic_now();
  const std::int64_t unix_offset_ns = unix_offset().nanoseconds + epoch.nanoseconds;
  SessionOptions options;
  options.out = files_.folder();
  options.with_reader = false;
  options.plan = schedule_on_one_core(cell_, -1, {});
  Sinks sinks(cell_, options, unix_offset_ns);
  ASSERT_NE(sinks.inputs(), nullptr);
  SessionGroups groups(
      cell_, options, {1, 0}, sinks, nullptr,
      [epoch] { return Time{} + (monotonic_now() - epoch); }, unix_offset_ns,
      read_background_scene(cell_, nullptr));
  ASSERT_NE(groups.background(), nullptr);
  BackgroundGroup& background = *groups.background();
  background.run_due_slices(at_ms(550));
  EXPECT_EQ(background.counts().robot.followed, 0);
  EXPECT_EQ(background.counts().joints_used, 0);

  SimulatedRobotDriver driver({"gripper", "slide"}, {9, k_slide_shown_m});
  // When the second message is counted, the first one is stored.
  for (int i = 0; i < 1000 && sinks.inputs()->counts().joints < 2; ++i) {
    driver.publish_joints();
    (void)sleep_until(monotonic_now() + milliseconds(10));
  }
  ASSERT_GE(sinks.inputs()->counts().joints, 2u);
  background.run_due_slices(at_ms(1150));
  CompanionResult result;
  groups.report(result);
  ASSERT_TRUE(result.background);
  EXPECT_GE(result.background->robot.followed, 4) << name_of(result.background->robot.last);
  EXPECT_LE(result.background->longest_steps,
            k_background_steps_max + std::max(k_map_item_steps_max, k_follow_item_steps_max));
  const auto robot = as_json(result).at("background").at("references");
  EXPECT_GE(robot.at("joint_states_used"), 1);
  EXPECT_EQ(robot.at("pictures_without_joints"), 0);
  sinks.close(result);
  EXPECT_GE(result.dds_received.joints, 2u);
}

}  // namespace
}  // namespace glint
