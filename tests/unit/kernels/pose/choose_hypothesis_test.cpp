#include "kernels/pose/choose_hypothesis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint::choose_hypothesis_test {
namespace {

const Vector3 k_tip(0, 0, -0.1);

// A hypothesis rotated by this angle from the camera's axes.
PoseHypothesis hypothesis_of(double radians, double chi_square, double distance_square) {
  PoseHypothesis reading;
  reading.T_camera_tool.rotation = from_rotation_vector(Vector3(radians, 0, 0));
  reading.chi_square = chi_square;
  reading.mahalanobis_square = distance_square;
  return reading;
}

ChosenHypothesis chosen_of(const std::vector<PoseHypothesis>& readings,
                           double odds_before = k_odds_max) {
  return choose_hypothesis(readings, odds_before, k_tip);
}

TEST(ChooseReading, TakesTheLeastSumAndGivesTheOddsAgainstTheNextThatIsApart) {
  const ChosenHypothesis chosen = chosen_of({hypothesis_of(0.6, 9, 20), hypothesis_of(0, 8, 5),
                                             hypothesis_of(0.05, 9, 5), hypothesis_of(1, 7, 30)});
  EXPECT_EQ(chosen.index, 1);
  EXPECT_DOUBLE_EQ(chosen.odds, 16) << "0.05 rad beside it is the same pose";
  EXPECT_FALSE(chosen.switched);
}

TEST(ChooseReading, CountsASurpriseForNoMoreThanTheOddsOfWhatWasFollowed) {
  // The mirrored pose has a chi-square lower by 3 in each frame, and is 50 sigma from the followed
  // one.
  double odds = 10;
  int frames = 0;
  ChosenHypothesis chosen;
  while (!chosen.switched && frames < 20) {
    chosen = chosen_of({hypothesis_of(0, 6, 4), hypothesis_of(0.7, 3, 2500)}, odds);
    odds = chosen.odds;
    ++frames;
  }
  EXPECT_EQ(frames, 4) << "10, 7, 4, 1, and then the other one by 2";
  EXPECT_EQ(chosen.index, 1);
  EXPECT_DOUBLE_EQ(chosen.odds, 2);
  EXPECT_LT(chosen.odds, k_odds_min);
}

TEST(ChooseReading, GathersEvidenceUpToABound) {
  double odds = 1;
  for (int frame = 0; frame < 3; ++frame)
    odds = chosen_of({hypothesis_of(0, 3, 4), hypothesis_of(0.7, 9, 2500)}, odds).odds;
  EXPECT_DOUBLE_EQ(odds, 19);
  for (int frame = 0; frame < 20; ++frame)
    odds = chosen_of({hypothesis_of(0, 3, 4), hypothesis_of(0.7, 9, 2500)}, odds).odds;
  EXPECT_DOUBLE_EQ(odds, k_odds_max);
}

TEST(ChooseReading, IsUnexpectedWhereTheFollowedReadingIsMissing) {
  const ChosenHypothesis missing = chosen_of({hypothesis_of(0.7, 3, 2500)});
  EXPECT_TRUE(missing.unexpected);
  EXPECT_FALSE(missing.switched);
}

TEST(ChooseReading, CountsOfAFollowedReadingNoMoreThanTheNoiseExplains) {
  PoseHypothesis bounded = hypothesis_of(0, 300, 5);
  bounded.chi_square_max = 20;
  const ChosenHypothesis settled = chosen_of({bounded, hypothesis_of(0.7, 3, 2500)});
  EXPECT_EQ(settled.index, 0);
  EXPECT_DOUBLE_EQ(settled.odds, (3 + 5 + 40) - (20 + 5));
  const ChosenHypothesis doubtful = chosen_of({bounded, hypothesis_of(0.7, 3, 2500)}, 5);
  EXPECT_EQ(doubtful.index, 1) << "the other one by 12";
  EXPECT_TRUE(doubtful.switched);
  EXPECT_DOUBLE_EQ(doubtful.odds, 12);
}

TEST(ChooseReading, WithoutAnotherReadingIsSurerFrameByFrame) {
  EXPECT_DOUBLE_EQ(chosen_of({hypothesis_of(0, 3, 4)}, 5).odds, 5 + k_no_alternative_odds);
  EXPECT_DOUBLE_EQ(chosen_of({hypothesis_of(0, 3, 4), hypothesis_of(0.01, 4, 4)}, 5).odds,
                   5 + k_no_alternative_odds);
}

TEST(AreApart, BeginsAtACentimetreOfTheTipOrAnEighthOfARadian) {
  const Pose here{from_rotation_vector({0.3, -0.2, 0.5}), {0.1, 0.2, 0.6}};
  const auto shifted = [&](double metres) {
    return are_apart(here, {here.rotation, here.translation + Vector3(0, metres, 0)}, k_tip);
  };
  EXPECT_FALSE(are_apart(here, here, k_tip));
  EXPECT_FALSE(shifted(0.0099));
  EXPECT_TRUE(shifted(0.0101));
  // Rotation about the tip, so that the tip does not move.
  const auto switched = [&](double radians, double sign) {
    Pose there;
    const Quaternion by = from_rotation_vector({0, radians, 0});
    there.rotation = by * here.rotation;
    there.rotation.coeffs() *= sign;
    there.translation = here * k_tip - there.rotation * k_tip;
    return are_apart(here, there, k_tip);
  };
  for (const double sign : {1.0, -1.0}) {
    EXPECT_FALSE(switched(0.1295, sign));
    EXPECT_TRUE(switched(0.1305, sign));
  }
  // A rotation about the origin moves a tip that is far from it.
  EXPECT_FALSE(are_apart({}, {from_rotation_vector({0.09, 0, 0}), Vector3::Zero()}, k_tip));
  EXPECT_TRUE(are_apart({}, {from_rotation_vector({0.11, 0, 0}), Vector3::Zero()}, k_tip));
}

// The followed hypothesis has the least squared Mahalanobis distance, up to an upper limit.
TEST(ChooseReading, FollowsTheLeastSurpriseUpToItsLimit) {
  EXPECT_TRUE(chosen_of({hypothesis_of(0.7, 3, 100), hypothesis_of(0, 90, k_followed_nis_max)}, 20)
                  .switched);
  EXPECT_TRUE(
      chosen_of({hypothesis_of(0.7, 3, 100), hypothesis_of(0, 90, k_followed_nis_max + 1)}, 20)
          .unexpected);
  // Of two that may be followed, only the nearer one's chi-square is bounded.
  PoseHypothesis near = hypothesis_of(0, 90, 4), far = hypothesis_of(0.7, 90, 30);
  near.chi_square_max = far.chi_square_max = 20;
  for (const bool swapped : {false, true}) {
    const ChosenHypothesis chosen = swapped ? chosen_of({far, near}) : chosen_of({near, far});
    EXPECT_EQ(chosen.index, swapped ? 1 : 0);
    EXPECT_DOUBLE_EQ(chosen.odds, std::min(k_odds_max, (90 + 30) - (20 + 4.0)));
    EXPECT_FALSE(chosen.switched);
  }
  near.chi_square = 12;
  far.chi_square = 12;
  EXPECT_DOUBLE_EQ(chosen_of({near, far}).odds, 30 - 4) << "less than the noise explains";
}

// Ties: the first is chosen. A squared Mahalanobis distance at its bound does not count as
// outweighed.
TEST(ChooseReading, TakesTheFirstAmongEquals) {
  EXPECT_EQ(
      chosen_of({hypothesis_of(0, 5, 5), hypothesis_of(0.7, 5, 5), hypothesis_of(1, 4, 6)}).index,
      0);
  EXPECT_DOUBLE_EQ(chosen_of({hypothesis_of(0, 5, 5), hypothesis_of(0.7, 5, 5)}).odds, 0);
  const ChosenHypothesis at_bound =
      chosen_of({hypothesis_of(0, 90, 10), hypothesis_of(0.7, 3, 30)}, 20);
  EXPECT_EQ(at_bound.index, 1);
  EXPECT_FALSE(at_bound.switched);
  EXPECT_TRUE(chosen_of({hypothesis_of(0, 90, 10), hypothesis_of(0.7, 3, 30.5)}, 20).switched);
}

TEST(ChooseReading, WithoutAnExpectationComparesChiSquareAlone) {
  const ChosenHypothesis chosen = chosen_of({hypothesis_of(0.7, 9, 0), hypothesis_of(0, 3, 0)}, 7);
  EXPECT_EQ(chosen.index, 1);
  EXPECT_DOUBLE_EQ(chosen.odds, 6);
  EXPECT_FALSE(chosen.switched || chosen.unexpected);
  PoseHypothesis bounded =
      hypothesis_of(0, 300, 0);  // without a prediction chi-square is not bounded
  bounded.chi_square_max = 20;
  EXPECT_EQ(chosen_of({hypothesis_of(0.7, 100, 0), bounded}).index, 0);
}

}  // namespace
}  // namespace glint::choose_hypothesis_test
