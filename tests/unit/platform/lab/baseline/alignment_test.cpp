#include "platform/lab/experiments/alignment.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "painted_frame.hpp"

namespace glint {
namespace {

const Pose k_T_reference_world = turned(0.3, -1.2, 2.0, {1.2, -0.7, 0.9});

// A tip with little motion, far from the world's origin, and a small error of alternating sign.
std::vector<PosePair> samples(int count, double error_m, double error_rad) {
  std::vector<PosePair> pairs;
  for (int i = 0; i < count; ++i) {
    const double sign = i % 2 == 0 ? 1 : -1;
    const Pose T_world_tip = turned(0.1, 0.2 + 0.001 * i, 0.3, {4, 5 + 0.0001 * i, -3});
    Pose T_reference_tip = k_T_reference_world * T_world_tip;
    T_reference_tip.translation += Vector3(sign * error_m, 0, -sign * error_m);
    T_reference_tip.rotation =
        from_rotation_vector(Vector3(0, sign * error_rad, 0)) * T_reference_tip.rotation;
    pairs.push_back({T_reference_tip, T_world_tip});
  }
  return pairs;
}

TEST(Alignment, FindsTheTransformBetweenTheWorlds) {
  const Pose found = align_worlds(samples(100, 0.001, 0.01));
  EXPECT_LT(found.rotation.angularDistance(k_T_reference_world.rotation), 1e-4);
  const Vector3 tip(4, 5, -3);
  EXPECT_LT((found * tip - k_T_reference_world * tip).norm(), 1e-4);
}

TEST(Alignment, IsDeafToOneBadSampleInTen) {
  std::vector<PosePair> pairs = samples(100, 0.001, 0.01);
  for (std::size_t i = 0; i < pairs.size(); i += 10) {
    pairs[i].T_world_tip = turned(1, 1, 1, {2, 2, 2});
  }
  const Pose found = align_worlds(pairs);
  const Vector3 tip(4, 5, -3);
  EXPECT_LT(found.rotation.angularDistance(k_T_reference_world.rotation), 2e-3);
  EXPECT_LT((found * tip - k_T_reference_world * tip).norm(), 1e-3);
}

TEST(Alignment, GivesTheIdentityForNoSamples) {
  const Pose found = align_worlds({});
  EXPECT_EQ(found.translation, Vector3::Zero());
}

TEST(Alignment, SignsErrorsAsSeenMinusReference) {
  PosePair pair;
  pair.T_reference_tip = turned(0, 0, 0.5, {1, 0, 0});
  pair.T_world_tip = pair.T_reference_tip;
  pair.T_world_tip.translation += Vector3(0.002, 0, -0.003);
  pair.T_world_tip.rotation = from_rotation_vector(Vector3(0, 0.1, 0)) * pair.T_world_tip.rotation;
  const PoseError error = pose_error({}, pair);
  EXPECT_LT((error.position_m - Vector3(0.002, 0, -0.003)).norm(), 1e-12);
  EXPECT_LT((error.rotation_rad - Vector3(0, 0.1, 0)).norm(), 1e-12);
}

}  // namespace
}  // namespace glint
