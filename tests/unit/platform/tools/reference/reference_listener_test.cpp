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

constexpr Duration k_patience = milliseconds(k_patience_ms);

// The joint states include a joint of another robot, and their order is not the URDF's.
TEST_F(ReferenceListening, GivesWhatFilesGive) {
  const test::Files files;
  const RobotModel from_file = load_robot({files.write("arm.urdf", post_arm_xml()), {}});
  const std::vector<double> given = {0.4, 0.02};

  RobotSpeaker speaker({"slide", "gripper", "turn"}, {0.02, 9, 0.4});
  speaker.say_description(post_arm_xml());
  ReferenceListener listener(test_settings(), {true, true, true}, k_patience,
                             [&](double, const std::string&) {
                               speaker.say_joints();
                               speaker.say_guess(k_post_arm_guess);
                             });
  const RobotModel heard = load_robot({"rt/robot_description", {}, {}, listener.description()});
  EXPECT_EQ(heard.inputs, (std::vector<std::string>{"turn", "slide"}));
  const HeardPlace place = listener.place(heard.inputs);
  EXPECT_EQ(place.positions, given);
  EXPECT_STREQ(place.guess.frame.data(), "hmd_tof_optical");

  const Reference by_files = find_reference(post_arm_scene(from_file, given), k_post_arm_guess, {});
  const Reference by_ear =
      find_reference(post_arm_scene(heard, place.positions), place.guess.pose, {});
  EXPECT_EQ(by_files.verdict, ReferenceVerdict::accepted) << by_files.why;
  EXPECT_EQ(by_ear.verdict, ReferenceVerdict::accepted) << by_ear.why;
  const Pose &a = by_files.found.alignment.T_world_base, &b = by_ear.found.alignment.T_world_base;
  EXPECT_LT((a.translation - b.translation).norm(), 1e-9);  // the quaternion is normalised again
  EXPECT_LT(a.rotation.angularDistance(b.rotation), 1e-7);
  EXPECT_LT((b.translation - k_post_arm_truth.translation).norm(), 1e-3);
}

TEST_F(ReferenceListening, TakesTheNewestStateOfJointsWhenTheGuessComes) {
  RobotSpeaker early({"turn"}, {0.1}), late({"turn"}, {0.7});
  int said = 0;
  ReferenceListener listener(test_settings(), {false, true, true}, k_patience,
                             [&](double, const std::string& topics) {
                               if (topics != "rt/initialpose") {
                                 EXPECT_EQ(topics, "rt/joint_states, rt/initialpose");
                                 early.say_joints();
                               } else if (late.is_known()) {
                                 late.say_joints();
                                 if (++said > 4) late.say_guess(k_post_arm_truth);
                               }
                             });
  EXPECT_EQ(listener.place({"turn"}).positions, std::vector<double>{0.7});
}

TEST_F(ReferenceListening, SaysWhatWasNotHeardAndWhoPublishesIt) {
  RobotSpeaker speaker({"turn", "slide"}, {0.1, 0.2});
  const Duration little = milliseconds(300);
  expect_input_error(
      [&] {
        ReferenceListener listener(test_settings(), {true, true, true}, little,
                                   [&](double, const std::string&) { speaker.say_joints(); });
        (void)listener.description();
      },
      {"0.3 s on lo, domain 0", "rt/robot_description: nothing heard", "robot_state_publisher",
       "--urdf", "rt/initialpose: nothing heard", "2D Pose Estimate", "--seed"});
  expect_input_error(
      [&] {
        ReferenceListener listener(test_settings(), {false, true, false}, little, {});
        (void)listener.place({"turn"});
      },
      {"rt/joint_states: nothing heard", "joint_state_publisher", "--joints"});
}

TEST_F(ReferenceListening, NamesTheJointThatNoStateHas) {
  RobotSpeaker speaker({"turn", "wrist", "wrist"}, {0.1, 0.2, 0.3});
  for (const std::string lacking : {"elbow", "wrist"}) {
    expect_input_error(
        [&] {
          ReferenceListener listener(test_settings(), {false, true, false}, milliseconds(1000),
                                     [&](double, const std::string&) { speaker.say_joints(); });
          (void)listener.place({"turn", lacking});
        },
        {"rt/joint_states: no state", ("'" + lacking + "'").c_str(), "all of the robot's joints"});
  }
}

}  // namespace
}  // namespace glint
