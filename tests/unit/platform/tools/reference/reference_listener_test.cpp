// Robot description, joint states and initial guess from another DDS participant instead of files.
#include "platform/tools/reference/reference_listener.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "platform/tools/reference/find_reference.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/robot_speaker.hpp"
#include "tests/unit/platform/tools/calibrate/expect_message.hpp"
#include "tests/unit/platform/tools/reference/post_arm.hpp"

namespace glint {
namespace {

using ReferenceListening = DdsTest;
using test::expect_input_error;

constexpr Duration k_timeout = milliseconds(k_timeout_ms);

// The joint states include a joint of another robot, and their order is not the URDF's.
TEST_F(ReferenceListening, GivesWhatFilesGive) {
  const test::Files files;
  const RobotModel from_file = load_robot({files.write("arm.urdf", post_arm_xml()), {}});
  const std::vector<double> given = {0.4, 0.02};

  SimulatedRobotDriver speaker({"slide", "gripper", "turn"}, {0.02, 9, 0.4});
  speaker.publish_description(post_arm_xml());
  ReferenceListener listener(test_settings(), {true, true, true}, k_timeout,
                             [&](double, const std::string&) {
                               speaker.publish_joints();
                               speaker.publish_guess(k_post_arm_guess);
                             });
  const RobotModel received = load_robot({"rt/robot_description", {}, {}, listener.description()});
  EXPECT_EQ(received.inputs, (std::vector<std::string>{"turn", "slide"}));
  const ReceivedInputs inputs = listener.wait_for_inputs(received.inputs);
  EXPECT_EQ(inputs.positions, given);
  EXPECT_STREQ(inputs.guess.frame.data(), "hmd_tof_optical");

  const Reference by_files = find_reference(post_arm_scene(from_file, given), k_post_arm_guess, {});
  const Reference by_dds =
      find_reference(post_arm_scene(received, inputs.positions), inputs.guess.pose, {});
  EXPECT_EQ(by_files.verdict, ReferenceVerdict::accepted) << by_files.reason;
  EXPECT_EQ(by_dds.verdict, ReferenceVerdict::accepted) << by_dds.reason;
  const Pose &a = by_files.found.alignment.T_world_base, &b = by_dds.found.alignment.T_world_base;
  EXPECT_LT((a.translation - b.translation).norm(), 1e-9);  // the quaternion is normalised again
  EXPECT_LT(a.rotation.angularDistance(b.rotation), 1e-7);
  EXPECT_LT((b.translation - k_post_arm_truth.translation).norm(), 1e-3);
}

TEST_F(ReferenceListening, TakesTheNewestStateOfJointsWhenTheGuessComes) {
  SimulatedRobotDriver early({"turn"}, {0.1}), late({"turn"}, {0.7});
  int published = 0;
  ReferenceListener listener(test_settings(), {false, true, true}, k_timeout,
                             [&](double, const std::string& topics) {
                               if (topics != "rt/initialpose") {
                                 EXPECT_EQ(topics, "rt/joint_states, rt/initialpose");
                                 early.publish_joints();
                               } else if (late.is_matched()) {
                                 late.publish_joints();
                                 if (++published > 4) late.publish_guess(k_post_arm_truth);
                               }
                             });
  EXPECT_EQ(listener.wait_for_inputs({"turn"}).positions, std::vector<double>{0.7});
}

TEST_F(ReferenceListening, SaysWhatWasNotHeardAndWhoPublishesIt) {
  SimulatedRobotDriver speaker({"turn", "slide"}, {0.1, 0.2});
  const Duration little = milliseconds(300);
  expect_input_error(
      [&] {
        ReferenceListener listener(test_settings(), {true, true, true}, little,
                                   [&](double, const std::string&) { speaker.publish_joints(); });
        (void)listener.description();
      },
      {"0.3 s on lo, domain 0", "rt/robot_description: no message", "robot_state_publisher",
       "--urdf", "rt/initialpose: no message", "2D Pose Estimate", "--initial-pose"});
  expect_input_error(
      [&] {
        ReferenceListener listener(test_settings(), {false, true, false}, little, {});
        (void)listener.wait_for_inputs({"turn"});
      },
      {"rt/joint_states: no message", "joint_state_publisher", "--joints"});
}

TEST_F(ReferenceListening, NamesTheJointThatNoStateHas) {
  SimulatedRobotDriver speaker({"turn", "wrist", "wrist"}, {0.1, 0.2, 0.3});
  for (const std::string missing : {"elbow", "wrist"}) {
    expect_input_error(
        [&] {
          ReferenceListener listener(test_settings(), {false, true, false}, milliseconds(1000),
                                     [&](double, const std::string&) { speaker.publish_joints(); });
          (void)listener.wait_for_inputs({"turn", missing});
        },
        {"rt/joint_states: no state", ("'" + missing + "'").c_str(), "all of the robot's joints"});
  }
}

}  // namespace
}  // namespace glint
