// Tracking of a robot given as a point cloud: any limit of steps a slice gives the same bits.
#include <gtest/gtest.h>

#include "kernels/registration/follow_reference.hpp"
#include "tests/unit/heap_count.hpp"
#include "tests/unit/kernels/registration/box_model.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint::follow_slices_test {
namespace {

using test::BoxArm;
using test::k_truth;
using test::SampledModel;

constexpr int k_pixels = 160 * 120;

struct PointWorld {
  BoxArm model;
  SampledModel sampled{model, 0.004f};
  Pinhole camera{160, 120, 150, 150, 80, 60};
  std::vector<float> depth = std::vector<float>(k_pixels);
  std::mt19937 random{5};
  RobotPoseTracker whole, sliced;
  int slices = 0;

  PointWorld() {
    Matrix6 covariance = Matrix6::Identity() * 1e-6;
    for (RobotPoseTracker* follower : {&whole, &sliced}) {
      EXPECT_EQ(follower->prepare(k_pixels, 100'000), Reason::none);
      follower->begin(k_truth, covariance, Time{});
    }
  }
  [[nodiscard]] SceneView view() const { return {camera, depth, {}, {}, {}, sampled.cloud()}; }
  void draw(const Vector3& shift) {
    std::vector<std::int32_t> face(depth.size());
    std::vector<ProjectedCorner> corners(64);
    EXPECT_EQ(
        render_depth({model.corners, model.faces}, {k_truth.rotation, k_truth.translation + shift},
                     camera, {depth, face, corners}),
        Reason::none);
    std::normal_distribution<float> noise(0, 0.004f);
    for (float& z : depth) z = z == 0 ? 1.9f : z + noise(random);
  }
  void look(Time time, int steps) {
    ASSERT_TRUE(whole.look(view(), time));
    while (whole.step()) {
    }
    ASSERT_TRUE(sliced.look(view(), time));
    for (; !sliced.idle(); ++slices) {
      const int taken = sliced.step(steps);
      ASSERT_GT(taken, 0);
      ASSERT_LE(taken, steps + k_follow_item_steps_max);
    }
    EXPECT_EQ(sliced.step(steps), 0);
  }
};

class FollowInSlices : public testing::TestWithParam<int> {};

TEST_P(FollowInSlices, GivesTheBitsOfWholeOnes) {
  PointWorld world;
  const Vector3 shifts[] = {{0.002, 0, 0}, {0.004, 0.001, 0}, {0.05, 0, 0}};
  const FollowOutcome outcomes[] = {FollowOutcome::followed, FollowOutcome::followed,
                                    FollowOutcome::jumped};
  const int looks = test::repetitions(3, 1);
  for (int i = 0; i < looks; ++i) {
    world.draw(shifts[i]);
    const Time time{(i + 1) * std::int64_t{1'000'000'000}};
    world.look(time, GetParam());
    const FollowReport &a = world.whole.report(), &b = world.sliced.report();
    EXPECT_EQ(b.outcome, outcomes[i]) << name_of(b.outcome);
    EXPECT_EQ(a.outcome, b.outcome);
    EXPECT_EQ(a.shift_m, b.shift_m);
    EXPECT_EQ(a.turn_rad, b.turn_rad);
    EXPECT_EQ(a.seen.steps, b.seen.steps);
    EXPECT_EQ(a.seen.pairs, b.seen.pairs);
    EXPECT_EQ(a.seen.covariance, b.seen.covariance);
    EXPECT_EQ(a.judgement.inliers, b.judgement.inliers);
    EXPECT_EQ(a.judgement.median_m, b.judgement.median_m);
    EXPECT_EQ(a.judgement.outline.falls, b.judgement.outline.falls);
    const FollowedReference one = world.whole.reference(time), two = world.sliced.reference(time);
    EXPECT_EQ(one.T_world_base.translation, two.T_world_base.translation);
    EXPECT_EQ(one.T_world_base.rotation.coeffs(), two.T_world_base.rotation.coeffs());
    EXPECT_EQ(one.covariance, two.covariance);
  }
  // The total number of steps does not depend on the slices: short slices are many.
  if (GetParam() == 1) {
    EXPECT_GT(world.slices, 3'000 * looks);
  }
}

INSTANTIATE_TEST_SUITE_P(OfAnySize, FollowInSlices, testing::Values(1, 999, 50'000, 1 << 29));

TEST(FollowSlices, TakeNothingFromTheHeap) {
  PointWorld world;
  world.draw({0.002, 0, 0});
  const HeapCount heap;
  ASSERT_TRUE(world.sliced.look(world.view(), Time{1'000'000'000}));
  while (!world.sliced.idle()) (void)world.sliced.step(20'000);
  EXPECT_EQ(heap.count(), 0u);
}

}  // namespace
}  // namespace glint::follow_slices_test
