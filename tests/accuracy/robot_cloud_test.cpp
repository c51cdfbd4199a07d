// A UR5, located by its exported points in simulated depth images with ground truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "platform/lab/experiments/robot_scenes.hpp"
#include "platform/tools/reference/find_reference.hpp"
#include "platform/tools/robot/sample_robot.hpp"

namespace glint {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct Found {
  double error_mm = 0, sigma_mm = 0;
};

// Without alternative initial guesses: the accuracy of the alignment alone.
Found found_in(const SimulatedScene& scene, int number) {
  Pose start = scene.T_world_base;
  start.translation += Vector3(0.05, -0.04, 0.06);
  start.rotation = pose_from_xyz_rpy({0, 0, 0, 0.1, -0.08, 0.12}).rotation * start.rotation;
  FindReferenceSettings alone;
  alone.search_alternatives = false;
  const Reference reference = find_reference(scene.frames, start, alone);
  EXPECT_EQ(reference.verdict, ReferenceVerdict::accepted) << number << ": " << reference.reason;
  const ModelAlignment& end = reference.found.alignment;
  return {1e3 * (end.T_world_base.translation - scene.T_world_base.translation).norm(),
          1e3 * std::sqrt(end.covariance.topLeftCorner<3, 3>().trace())};
}

TEST(RobotCloud, FindsAUr5HalfHiddenAsExactlyAsItSaysAndNearlyAsItsMeshesDo) {
  const char* data = std::getenv("GLINT_TEST_DATA");
  const std::string folder = std::string(data == nullptr ? "" : data) + "/robots/ur5";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  const RobotModel robot = load_robot({folder + "/ur5_robot.urdf", {folder}, Geometry::collision});
  const std::string file = ::testing::TempDir() + "glint_ur5_cloud.ply";
  write_robot_cloud(file, sample_robot(robot, k_robot_cloud_points));
  const RobotCloud cloud = read_robot_cloud(file);
  std::filesystem::remove(file);
  std::vector<double> in_sigmas, sigmas;
  for (int i = 0; i < 7; ++i) {
    SimulatedScene scene = simulate_scene(robot, {}, 7, static_cast<std::uint64_t>(i));
    const Found by_meshes = found_in(scene, i);
    for (SceneFrame& frame : scene.frames) {
      frame.cloud = posed_cloud(cloud, scene.positions, file);
      frame.model = {};
    }
    const Found by_points = found_in(scene, i);
    in_sigmas.push_back(by_points.error_mm / by_points.sigma_mm);
    sigmas.push_back(by_points.sigma_mm / by_meshes.sigma_mm);
  }
  RecordProperty("median_error_in_sigmas", std::to_string(median(in_sigmas)));
  RecordProperty("median_sigma_beside_meshes", std::to_string(median(sigmas)));
  EXPECT_LE(median(in_sigmas), 1.3);
  EXPECT_LE(median(sigmas), 1.3);
}

}  // namespace
}  // namespace glint
