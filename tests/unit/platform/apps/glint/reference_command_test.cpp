// `glint reference --listen` as a process; the test acts as the robot's driver and as RViz.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "platform/formats/npy.hpp"
#include "tests/unit/platform/apps/glint/command_process.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/robot_speaker.hpp"
#include "tests/unit/platform/tools/reference/post_arm.hpp"

namespace glint {
namespace {

const std::vector<double> k_shown_positions = {0.4, 0.02};

class ReferenceCommand : public DdsTest {
 protected:
  void SetUp() override {
    DdsTest::SetUp();
    const RobotModel robot = load_robot({files_.write("arm.urdf", post_arm_xml()), {}});
    const SceneFrame frame = post_arm_scene(robot, k_shown_positions).front();
    files_.write("depth.npy", npy_float32_bytes({{120, 160}, frame.depth_m}));
    files_.write("camera.yaml",
                 "header:\n  stamp: {sec: 0, nanosec: 0}\n  frame_id: hmd_tof_optical\n"
                 "width: 160\nheight: 120\nk: [150, 0, 79.5, 0, 150, 59.5, 0, 0, 1]\n");
  }
  [[nodiscard]] std::string path(const char* name) const { return files_.folder() + "/" + name; }
  [[nodiscard]] std::vector<std::string> listens(const char* seconds) const {
    return {"reference",           "--listen", seconds,           "--camera",
            path("camera.yaml"),   "--depth",  path("depth.npy"), "--json",
            path("reference.json")};
  }

  const test::Files files_;
};

TEST_F(ReferenceCommand, FindsTheRobotThatItHearsOf) {
  SimulatedRobotDriver speaker({"slide", "gripper", "turn"}, {0.02, 9, 0.4});
  speaker.publish_description(post_arm_xml());
  CommandProcess command(listens("120"), path("words.txt"));
  const int code = command.exit_code([&] {
    speaker.publish_joints();
    speaker.publish_guess(k_post_arm_guess);
  });
  ASSERT_EQ(code, 0) << command.words();
  std::ifstream file(path("reference.json"));
  const auto found = nlohmann::json::parse(file);
  EXPECT_EQ(found.at("verdict"), "accepted") << found.at("why");
  EXPECT_EQ(found.at("robot"), "arm");
  const std::vector<double> T = found.at("T_camera_base");
  ASSERT_EQ(T.size(), 16u);
  const Matrix3 turn = k_post_arm_truth.rotation.toRotationMatrix();
  for (int r = 0; r < 3; ++r) {
    const auto row = static_cast<std::size_t>(4 * r);
    EXPECT_NEAR(T[row + 3], k_post_arm_truth.translation(r), 1e-3);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(T[row + static_cast<std::size_t>(c)], turn(r, c), 3e-3);
  }
}

TEST_F(ReferenceCommand, RefusesAGuessInAnotherFrameThanItsCameras) {
  SimulatedRobotDriver speaker({"turn", "slide"}, k_shown_positions);
  speaker.publish_description(post_arm_xml());
  CommandProcess command(listens("120"), path("words.txt"));
  const int code = command.exit_code([&] {
    speaker.publish_joints();
    speaker.publish_guess(k_post_arm_guess, "map");
  });
  EXPECT_EQ(code, 2);
  const std::string words = command.words();
  EXPECT_NE(
      words.find(
          "glint: rt/initialpose: an initial pose in frame \"map\"; expected T_camera_base in "
          "\"hmd_tof_optical\", the frame_id of " +
          path("camera.yaml")),
      std::string::npos)
      << words;
}

TEST_F(ReferenceCommand, EndsWithTheJointsThatNobodySaid) {
  SimulatedRobotDriver speaker({"turn", "slide"}, k_shown_positions);
  speaker.publish_description(post_arm_xml());
  CommandProcess command(listens("1"), path("words.txt"));
  EXPECT_EQ(command.exit_code([&] { speaker.publish_guess(k_post_arm_guess); }), 2);
  const std::string words = command.words();
  EXPECT_NE(words.find("glint: --listen: 1.0 s on lo, domain 0"), std::string::npos) << words;
  EXPECT_NE(words.find("rt/joint_states: no message; expected"), std::string::npos) << words;
  EXPECT_FALSE(std::ifstream(path("reference.json")).good());
}

}  // namespace
}  // namespace glint
