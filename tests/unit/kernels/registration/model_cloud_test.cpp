// Point cloud model posed by its links: in one call and in slices with any limit of steps.
#include "kernels/registration/model_cloud.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/unit/heap_count.hpp"

namespace glint::model_cloud_test {
namespace {

TEST(PoseCloud, MovesEachPointWithItsLink) {
  const std::vector<Vector3f> points = {{1, 0, 0}, {1, 0, 0}}, normals = points;
  const std::vector<std::uint16_t> links = {0, 1};
  LinkPoses poses;
  poses.count = 2;
  poses.T_root_link[1] = {Quaternion(Eigen::AngleAxisd(M_PI / 2, Vector3::UnitZ())), {0, 0, 5}};
  std::vector<Vector3f> moved(2), turned(2);
  ASSERT_EQ(pose_cloud({{points, normals, 0.01f}, links}, poses, moved, turned), Reason::none);
  EXPECT_EQ(moved[0], points[0]);
  EXPECT_LT((moved[1] - Vector3f(0, 1, 5)).norm(), 1e-6f);
  EXPECT_LT((turned[1] - Vector3f(0, 1, 0)).norm(), 1e-6f);
  poses.count = 1;
  EXPECT_EQ(pose_cloud({{points, normals, 0.01f}, links}, poses, moved, turned),
            Reason::out_of_range);
  EXPECT_EQ(pose_cloud({{points, {}, 0.01f}, links}, poses, moved, turned), Reason::out_of_range);
}

constexpr std::size_t k_points = 2'000;

// Points whose link changes often and sometimes stays; each link is rotated and translated.
struct Arm {
  std::vector<Vector3f> points, normals;
  std::vector<std::uint16_t> links;
  LinkPoses poses;
  std::vector<Vector3f> moved = std::vector<Vector3f>(k_points, Vector3f::Zero()), turned = moved;

  Arm() {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> any(-1, 1);
    const auto vector = [&] {
      const float x = any(random), y = any(random);
      return Vector3f(x, y, any(random));
    };
    poses.count = 7;
    for (Pose& pose : std::span(poses.T_root_link).first(7)) {
      const Vector3 axis = vector().cast<double>().normalized();
      pose.rotation = Quaternion(Eigen::AngleAxisd(static_cast<double>(any(random)), axis));
      pose.translation = vector().cast<double>();
    }
    for (std::size_t i = 0; i < k_points; ++i) {
      points.push_back(vector());
      normals.push_back(vector().normalized());
      links.push_back(static_cast<std::uint16_t>(i < 500 ? i % 7 : i / 300));
    }
  }
  [[nodiscard]] LinkCloud cloud() const { return {{points, normals, 0.01f}, links}; }
};

// Steps of each point, plus those of each change of link between successive points.
constexpr int k_steps = static_cast<int>(k_points) * k_posed_point_steps + 506 * k_posed_link_steps;

class PoseCloudInSlices : public testing::TestWithParam<int> {};

TEST_P(PoseCloudInSlices, GivesTheBitsOfAllAtOnce) {
  Arm whole, sliced;
  ASSERT_EQ(pose_cloud(whole.cloud(), whole.poses, whole.moved, whole.turned), Reason::none);
  PoseCloudRun run;
  ASSERT_EQ(run.start(sliced.cloud(), sliced.poses, sliced.moved, sliced.turned), Reason::none);
  int slices = 0, steps = 0;
  for (bool more = true; more; ++slices) {
    StepBudget budget(GetParam());
    more = run.step(budget);
    const int taken = GetParam() - budget.left();
    ASSERT_GT(taken, 0);
    ASSERT_LT(taken, GetParam() + k_posed_item_steps_max);
    steps += taken;
  }
  EXPECT_EQ(run.reason(), Reason::none);
  EXPECT_EQ(steps, k_steps);
  EXPECT_GE(slices, k_steps / (GetParam() + k_posed_item_steps_max));
  EXPECT_EQ(sliced.moved, whole.moved);
  EXPECT_EQ(sliced.turned, whole.turned);
}

INSTANTIATE_TEST_SUITE_P(OfAnySize, PoseCloudInSlices,
                         testing::Values(1, 7, 1000, SliceSize::k_steps_max));

TEST(PoseCloudSlices, BeginNoPointWhereNoStepIsLeft) {
  Arm arm;
  PoseCloudRun run;
  ASSERT_EQ(run.start(arm.cloud(), arm.poses, arm.moved, arm.turned), Reason::none);
  StepBudget spent(0);
  EXPECT_TRUE(run.step(spent));
  EXPECT_EQ(spent.left(), 0);
  EXPECT_EQ(arm.moved[0], Vector3f(0, 0, 0));
}

TEST(PoseCloudSlices, RefuseSpansOfDifferentSizes) {
  Arm arm;
  const LinkCloud cloud = arm.cloud();
  LinkCloud fewer_normals = cloud, fewer_links = cloud;
  fewer_normals.cloud.normals = cloud.cloud.normals.first(3);
  fewer_links.links = cloud.links.first(3);
  PoseCloudRun run;
  const auto refuses = [&](const LinkCloud& robot, std::size_t points, std::size_t normals) {
    const Reason reason = run.start(robot, arm.poses, std::span(arm.moved).first(points),
                                    std::span(arm.turned).first(normals));
    StepBudget all;
    EXPECT_FALSE(run.step(all)) << "there is nothing to do";
    EXPECT_EQ(all.left(), SliceSize::k_steps_max);
    EXPECT_EQ(run.reason(), reason);
    return reason == Reason::out_of_range;
  };
  EXPECT_TRUE(refuses(fewer_normals, k_points, k_points));
  EXPECT_TRUE(refuses(fewer_links, k_points, k_points));
  EXPECT_TRUE(refuses(cloud, k_points - 1, k_points));
  EXPECT_TRUE(refuses(cloud, k_points, k_points - 1));
}

TEST(PoseCloudSlices, EndAtALinkThatHasNoPose) {
  Arm arm;
  arm.poses.count = 6;
  PoseCloudRun run;
  ASSERT_EQ(run.start(arm.cloud(), arm.poses, arm.moved, arm.turned), Reason::none);
  for (StepBudget budget(1); run.step(budget); budget = StepBudget(1)) {
    ASSERT_EQ(run.reason(), Reason::none);
  }
  EXPECT_EQ(run.reason(), Reason::out_of_range);
  EXPECT_NE(arm.moved[5], Vector3f(0, 0, 0)) << "what was written until then stands";
  EXPECT_EQ(arm.moved[6], Vector3f(0, 0, 0));
  StepBudget budget;
  EXPECT_FALSE(run.step(budget)) << "it has ended";
}

// After a run that was interrupted, one that ended at a link without a pose, and a refused one.
TEST(PoseCloudSlices, StartedAgainPoseAsANewRun) {
  Arm fresh;
  ASSERT_EQ(pose_cloud(fresh.cloud(), fresh.poses, fresh.moved, fresh.turned), Reason::none);
  PoseCloudRun run;
  for (const int before : {0, 1, 2}) {
    Arm used, wrong;
    StepBudget some(before == 0 ? 5'000 : SliceSize::k_steps_max);
    if (before == 1) wrong.poses.count = 6;
    if (before == 2) wrong.links.pop_back();
    (void)run.start(wrong.cloud(), wrong.poses, wrong.moved, wrong.turned);
    EXPECT_EQ(run.step(some), before == 0);
    ASSERT_EQ(run.start(used.cloud(), used.poses, used.moved, used.turned), Reason::none);
    EXPECT_EQ(run.reason(), Reason::none);
    StepBudget all;
    EXPECT_FALSE(run.step(all));
    EXPECT_EQ(SliceSize::k_steps_max - all.left(), k_steps);
    EXPECT_EQ(used.moved, fresh.moved) << before;
    EXPECT_EQ(used.turned, fresh.turned) << before;
  }
}

TEST(PoseCloudSlices, TakeNothingFromTheHeap) {
  Arm arm;
  const HeapCount heap;
  PoseCloudRun run;
  ASSERT_EQ(run.start(arm.cloud(), arm.poses, arm.moved, arm.turned), Reason::none);
  for (StepBudget budget(1000); run.step(budget); budget = StepBudget(1000)) {
  }
  EXPECT_EQ(heap.count(), 0u);
}

TEST(PoseCloudSlices, TakeAsManyPointsAsThereMayBeAndNoMore) {
  for (const std::size_t count :
       {std::size_t{k_model_points_max}, std::size_t{k_model_points_max} + 1}) {
    const std::vector<Vector3f> points(count, Vector3f(1, 0, 0));
    const std::vector<std::uint16_t> links(count, 0);
    std::vector<Vector3f> moved(count), turned(count);
    LinkPoses poses;
    poses.count = 1;
    PoseCloudRun run;
    EXPECT_EQ(run.start({{points, points, 0.01f}, links}, poses, moved, turned),
              count > k_model_points_max ? Reason::out_of_range : Reason::none);
  }
}

}  // namespace
}  // namespace glint::model_cloud_test
