#include "kernels/motion/predict_motion.hpp"

#include <gtest/gtest.h>

#include "kernels/motion/occlusion_noise.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint {
namespace {

TEST(PredictPose, IsWhereTheFilterItselfWouldBeAndAsUnsureAsStrokesMakeIt) {
  test::Random random(1);
  for (const int ms : {1, 25, 50, 250}) {
    for (int trial = 0; trial < 50; ++trial) {
      const MotionState state = test::random_state(random);
      const Time time{ms * 1'000'000LL};
      MotionState later = state;
      propagate(later, time, {}, {1.3, 0.8});
      UncertainPose expected = pose_of(later);
      expected.covariance.topLeftCorner<3, 3>() += occlusion_covariance(
          state.velocity_m_s, linear_occlusion_share_1_s(state.velocity_m_s), 0.001 * ms);
      expected.covariance.bottomRightCorner<3, 3>() += occlusion_covariance(
          state.angular_velocity_rad_s, k_angular_occlusion_share_1_s, 0.001 * ms);
      const UncertainPose predicted = predict_pose(state, time, {}, {1.3, 0.8});
      EXPECT_EQ(predicted.time, time);
      EXPECT_LT(pose_difference(predicted.pose, expected.pose).norm(), 1e-14);
      EXPECT_LT((predicted.covariance - expected.covariance).norm(),
                1e-12 * expected.covariance.norm());
    }
  }
}

TEST(PredictPose, BeforeTheStateIsTheStatesOwn) {
  test::Random random(2);
  const MotionState state = test::random_state(random);
  for (const std::int64_t ns : {0LL, -1LL, -1'000'000'000LL}) {
    const UncertainPose predicted = predict_pose(state, Time{ns}, {}, {});
    EXPECT_EQ(predicted.pose.translation, state.pose.translation);
    EXPECT_EQ(predicted.covariance, pose_of(state).covariance);
  }
}

TEST(PredictPose, IsFiniteForTenSecondsAhead) {
  test::Random random(3);
  const UncertainPose predicted =
      predict_pose(test::random_state(random), Time{10'000'000'000}, {}, {10, 10});
  EXPECT_TRUE(predicted.covariance.allFinite());
  EXPECT_TRUE(predicted.pose.translation.allFinite());
}

TEST(PredictPose, GivesTheSameBitsEverywhere) {
  test::Random random(4);
  test::BitHash hash;
  for (int trial = 0; trial < 500; ++trial) {
    const MotionState state = test::random_state(random);
    const UncertainPose predicted = predict_pose(state, Time{random.below(100'000'000)}, {}, {});
    hash.add(predicted.pose);
    for (int i = 0; i < 36; ++i) hash.add(predicted.covariance(i / 6, i % 6));
  }
  EXPECT_EQ(hash.value(), 1942336314315432263u);
}

}  // namespace
}  // namespace glint
