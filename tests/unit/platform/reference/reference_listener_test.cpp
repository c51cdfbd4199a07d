// A description, joint states and a guess from another participant, in place of files.
#include "platform/reference/reference_listener.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "platform/dds/topic_names.hpp"
#include "platform/reference/find_reference.hpp"
#include "tests/unit/platform/calibrate/expect_message.hpp"
#include "tests/unit/platform/dds/inputs.hpp"
#include "tests/unit/platform/dds/isolated_network.hpp"
#include "tests/unit/platform/dds/peer.hpp"
#include "tests/unit/platform/dds/samples.hpp"
#include "tests/unit/platform/robot/files.hpp"

namespace glint {
namespace {

using ReferenceListening = DdsTest;
using test::expect_input_error;

constexpr Duration k_patience = milliseconds(k_patience_ms);

// An arm that reaches out from a post and can turn on it.
std::string arm_xml() {
  const auto link = [](const char* name, const char* size, const char* xyz) {
    return std::string("<link name='") + name + "'><collision><origin xyz='" + xyz +
           "'/><geometry><box size='" + size + "'/></geometry></collision></link>\n";
  };
  return test::robot_xml(link("post", "0.2 0.2 0.5", "0 0 0.25") +
                         link("beam", "0.5 0.11 0.1", "0.2 0 0.45") +
                         link("hand", "0.08 0.12 0.3", "0.41 0 0.35") +
                         test::joint_xml("turn", "revolute", "post", "beam") +
                         test::joint_xml("slide", "prismatic", "beam", "hand"));
}

// What a robot's driver and RViz would say, again and again.
class Speaker {
 public:
  explicit Speaker(std::vector<std::string> joints, std::vector<double> positions)
      : peer_(test_settings()), joints_(std::move(joints), std::move(positions)) {
    description_ = peer_.writer(text_type(), k_robot_description_topic, Reliability::reliable,
                                Durability::transient_local, 1);
    joint_states_ = peer_.writer(joint_state_type(), k_joint_states_topic, Reliability::best_effort,
                                 Durability::volatile_data, 5);
    guess_ = peer_.writer(pose_covariance_type(), k_initial_pose_topic, Reliability::reliable,
                          Durability::volatile_data, 10);
  }
  // Whom it speaks to knows its joints and its guess.
  [[nodiscard]] bool is_known() const {
    dds_publication_matched_status_t joints{}, guess{};
    dds_get_publication_matched_status(joint_states_, &joints);
    dds_get_publication_matched_status(guess_, &guess);
    return joints.current_count > 0 && guess.current_count > 0;
  }
  void say_description(std::string urdf) {
    const TextMessage message{urdf.data()};
    dds_write(description_, &message);
  }
  void say_joints() {
    const JointStateMessage message = joints_.message();
    dds_write(joint_states_, &message);
  }
  void say_guess(const Pose& pose) {
    std::string frame = "hmd_tof_optical";
    PoseCovarianceMessage message = guess_message(frame);
    const Vector3& t = pose.translation;
    const Quaternion& q = pose.rotation;
    message.pose.pose.position = {t.x(), t.y(), t.z()};
    message.pose.pose.orientation = {q.x(), q.y(), q.z(), q.w()};
    dds_write(guess_, &message);
  }

 private:
  Peer peer_;
  JointText joints_;
  dds_entity_t description_ = 0, joint_states_ = 0, guess_ = 0;
};

const Pose k_truth{
    pose_of_seed({0, 0, 0, 2.094, 0, 0}).rotation * pose_of_seed({0, 0, 0, 0, 0, 0.7}).rotation,
    {-0.1, 0.15, 1.3}};

std::vector<SceneFrame> scene_of(const RobotModel& robot, std::span<const double> positions) {
  SceneFrame frame;
  frame.camera = {160, 120, 150, 150, 80, 60};
  frame.model = posed_surface(robot, positions, "a test");
  frame.depth_m.resize(160 * 120);
  std::vector<std::int32_t> face(frame.depth_m.size());
  std::vector<ProjectedCorner> corners(frame.model.corners.size());
  EXPECT_EQ(
      render_depth(frame.model.surface(), k_truth, frame.camera, {frame.depth_m, face, corners}),
      Reason::none);
  for (float& z : frame.depth_m) z = z == 0 ? 2.2f : z;
  return {frame};
}

// The other robot's joint stands among them; the order is not the URDF's.
TEST_F(ReferenceListening, GivesWhatFilesGive) {
  const test::Files files;
  const RobotModel from_file = load_robot({files.write("arm.urdf", arm_xml()), {}});
  const std::vector<double> given = {0.4, 0.02};
  const Pose guess{k_truth.rotation * pose_of_seed({0, 0, 0, 0.05, 0.05, 0}).rotation,
                   k_truth.translation + Vector3(0.03, -0.03, 0.03)};

  Speaker speaker({"slide", "gripper", "turn"}, {0.02, 9, 0.4});
  speaker.say_description(arm_xml());
  ReferenceListener listener(test_settings(), {true, true, true}, k_patience,
                             [&](double, const std::string&) {
                               speaker.say_joints();
                               speaker.say_guess(guess);
                             });
  const RobotModel heard = load_robot({"rt/robot_description", {}, {}, listener.description()});
  EXPECT_EQ(heard.inputs, (std::vector<std::string>{"turn", "slide"}));
  const HeardPlace place = listener.place(heard.inputs);
  EXPECT_EQ(place.positions, given);
  EXPECT_STREQ(place.guess.frame.data(), "hmd_tof_optical");

  const Reference by_files = find_reference(scene_of(from_file, given), guess, {});
  const Reference by_ear = find_reference(scene_of(heard, place.positions), place.guess.pose, {});
  EXPECT_EQ(by_files.verdict, ReferenceVerdict::accepted) << by_files.why;
  EXPECT_EQ(by_ear.verdict, ReferenceVerdict::accepted) << by_ear.why;
  const Pose &a = by_files.found.alignment.T_world_base, &b = by_ear.found.alignment.T_world_base;
  EXPECT_LT((a.translation - b.translation).norm(), 1e-9);  // a guess is made of length 1 again
  EXPECT_LT(a.rotation.angularDistance(b.rotation), 1e-7);
  EXPECT_LT((b.translation - k_truth.translation).norm(), 1e-3);
}

TEST_F(ReferenceListening, TakesTheNewestStateOfJointsWhenTheGuessComes) {
  Speaker early({"turn"}, {0.1}), late({"turn"}, {0.7});
  int said = 0;
  ReferenceListener listener(test_settings(), {false, true, true}, k_patience,
                             [&](double, const std::string& topics) {
                               if (topics != "rt/initialpose") {
                                 EXPECT_EQ(topics, "rt/joint_states, rt/initialpose");
                                 early.say_joints();
                               } else if (late.is_known()) {
                                 late.say_joints();
                                 if (++said > 4) late.say_guess(k_truth);
                               }
                             });
  EXPECT_EQ(listener.place({"turn"}).positions, std::vector<double>{0.7});
}

TEST_F(ReferenceListening, SaysWhatWasNotHeardAndWhoPublishesIt) {
  Speaker speaker({"turn", "slide"}, {0.1, 0.2});
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
  Speaker speaker({"turn", "wrist", "wrist"}, {0.1, 0.2, 0.3});
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
