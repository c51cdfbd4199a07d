// A UR5 found by the points that were exported of it, in simulated depth with the truth beside it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "platform/experiments/robot_scenes.hpp"
#include "platform/reference/find_reference.hpp"
#include "platform/robot/sample_robot.hpp"

namespace glint {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

TEST(RobotCloud, FindsAUr5HalfHiddenAsExactlyAsItsMeshesDo) {
  const char* data = std::getenv("GLINT_TEST_DATA");
  const std::string folder = std::string(data == nullptr ? "" : data) + "/robots/ur5";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  const RobotModel robot = load_robot({folder + "/ur5_robot.urdf", {folder}, Geometry::collision});
  const std::string file = ::testing::TempDir() + "glint_ur5_cloud.ply";
  write_robot_cloud(file, sample_robot(robot, k_robot_cloud_points));
  const RobotCloud cloud = read_robot_cloud(file);
  std::filesystem::remove(file);
  std::vector<double> millimetres, degrees;
  for (std::uint64_t i = 0; i < 9; ++i) {
    SimulatedScene scene = simulate_scene(robot, {}, 7, i);
    for (SceneFrame& frame : scene.frames) {
      frame.cloud = posed_cloud(cloud, scene.positions, file);
      frame.model = {};
    }
    Pose start = scene.T_world_base;
    start.translation += Vector3(0.05, -0.04, 0.06);
    start.rotation = (pose_of_seed({0, 0, 0, 0.1, -0.08, 0.12}).rotation * start.rotation);
    const Reference reference = find_reference(scene.frames, start, {});
    EXPECT_EQ(reference.verdict, ReferenceVerdict::accepted) << i << ": " << reference.why;
    const Pose& end = reference.found.alignment.T_world_base;
    millimetres.push_back(1e3 * (end.translation - scene.T_world_base.translation).norm());
    degrees.push_back(57.29578 * end.rotation.angularDistance(scene.T_world_base.rotation));
  }
  RecordProperty("median_mm", std::to_string(median(millimetres)));
  RecordProperty("median_degrees", std::to_string(median(degrees)));
  EXPECT_LE(median(millimetres), 2.0);
  EXPECT_LE(median(degrees), 0.45);
}

}  // namespace
}  // namespace glint
