#include "platform/tools/reference/coarse_search.hpp"

#include <gtest/gtest.h>

#include <array>

#include "platform/tools/reference/find_reference.hpp"
#include "tests/unit/platform/tools/reference/post_arm.hpp"

namespace glint {
namespace {

RobotModel post_arm() {
  const test::Files files;
  return load_robot({files.write("arm.urdf", post_arm_xml()), {}});
}

TEST(CoarseSearch, HasAnEndNearTheRobotFromFarAway) {
  const std::vector<SceneFrame> scene = post_arm_scene(post_arm(), std::array{0.4, 0.02});
  CoarseSearch search(scene);
  const Pose start{
      pose_from_xyz_rpy({0, 0, 0, 0.5, -0.4, 0.4}).rotation * k_post_arm_truth.rotation,
      k_post_arm_truth.translation + Vector3(0.3, -0.25, 0.2)};
  const std::vector<CoarsePose> best = search.best(spread_poses(start, {}), 3, 0.06);
  ASSERT_FALSE(best.empty());
  EXPECT_LT(search.surface_motion_m(best[0].T_world_base, k_post_arm_truth), 0.05);
  EXPECT_GT(best[0].score, 0.4);
  for (std::size_t i = 1; i < best.size(); ++i) {
    EXPECT_LE(best[i].score, best[i - 1].score);
    EXPECT_GE(search.surface_motion_m(best[i].T_world_base, best[0].T_world_base), 0.06);
  }
}

TEST(CoarseSearch, SpreadsPosesOverTheRangeAndNotBeyond) {
  const SearchRange range{0.2, 0.3};
  Vector3 low = Vector3::Zero(), high = low;
  double turn = 0;
  const std::vector<Pose> poses = spread_poses(k_post_arm_truth, range);
  ASSERT_EQ(poses.size(), 1u + k_coarse_poses);
  EXPECT_EQ(poses[0].translation, k_post_arm_truth.translation);
  for (const Pose& pose : poses) {
    const Vector3 shift = pose.translation - k_post_arm_truth.translation;
    low = low.cwiseMin(shift);
    high = high.cwiseMax(shift);
    turn = std::max(turn, pose.rotation.angularDistance(k_post_arm_truth.rotation));
    EXPECT_TRUE(range.contains(k_post_arm_truth, pose));
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(low(axis), -0.2, 0.002);
    EXPECT_NEAR(high(axis), 0.2, 0.002);
  }
  EXPECT_GT(turn, 0.4);
}

TEST(CoarseSearch, HoldsNoPoseBeyondTheRange) {
  const SearchRange range{0.2, 0.3};
  Pose pose = k_post_arm_truth;
  pose.translation.x() += 0.36;
  EXPECT_FALSE(range.contains(k_post_arm_truth, pose));
  pose = k_post_arm_truth;
  pose.rotation = pose_from_xyz_rpy({0, 0, 0, 0, 0, 0.58}).rotation * pose.rotation;
  EXPECT_FALSE(range.contains(k_post_arm_truth, pose));
}

TEST(CoarseSearch, MeasuresTheMotionOfTheSurface) {
  const std::vector<SceneFrame> scene = post_arm_scene(post_arm(), std::array{0.4, 0.02});
  const CoarseSearch search(scene);
  Pose aside = k_post_arm_truth;
  aside.translation += Vector3(0.03, 0, 0.04);
  EXPECT_NEAR(search.surface_motion_m(k_post_arm_truth, aside), 0.05, 1e-9);
}

}  // namespace
}  // namespace glint
