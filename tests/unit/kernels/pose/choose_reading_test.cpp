#include "kernels/pose/choose_reading.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint::choose_reading_test {
namespace {

const Vector3 k_tip(0, 0, -0.1);

// Turned by so much from the camera's axes.
PoseReading reading_of(double radians, double chi_square, double surprise) {
  PoseReading reading;
  reading.T_camera_tool.rotation = from_rotation_vector(Vector3(radians, 0, 0));
  reading.chi_square = chi_square;
  reading.surprise = surprise;
  return reading;
}

ChosenReading chosen_of(const std::vector<PoseReading>& readings,
                        double odds_before = k_odds_most) {
  return choose_reading(readings, odds_before, k_tip);
}

TEST(ChooseReading, TakesTheLeastSumAndGivesTheOddsAgainstTheNextThatIsApart) {
  const ChosenReading chosen = chosen_of(
      {reading_of(0.6, 9, 20), reading_of(0, 8, 5), reading_of(0.05, 9, 5), reading_of(1, 7, 30)});
  EXPECT_EQ(chosen.index, 1);
  EXPECT_DOUBLE_EQ(chosen.odds, 16) << "0.05 rad beside it is the same pose";
  EXPECT_FALSE(chosen.turned);
}

TEST(ChooseReading, CountsASurpriseForNoMoreThanTheOddsOfWhatWasFollowed) {
  // The mirrored pose fits by 3 better in each frame, and is 50 sigma from what is followed.
  double odds = 10;
  int frames = 0;
  ChosenReading chosen;
  while (!chosen.turned && frames < 20) {
    chosen = chosen_of({reading_of(0, 6, 4), reading_of(0.7, 3, 2500)}, odds);
    odds = chosen.odds;
    ++frames;
  }
  EXPECT_EQ(frames, 4) << "10, 7, 4, 1, and then the other one by 2";
  EXPECT_EQ(chosen.index, 1);
  EXPECT_DOUBLE_EQ(chosen.odds, 2);
  EXPECT_LT(chosen.odds, k_odds_least);
}

TEST(ChooseReading, GathersEvidenceUpToABound) {
  double odds = 1;
  for (int frame = 0; frame < 3; ++frame)
    odds = chosen_of({reading_of(0, 3, 4), reading_of(0.7, 9, 2500)}, odds).odds;
  EXPECT_DOUBLE_EQ(odds, 19);
  for (int frame = 0; frame < 20; ++frame)
    odds = chosen_of({reading_of(0, 3, 4), reading_of(0.7, 9, 2500)}, odds).odds;
  EXPECT_DOUBLE_EQ(odds, k_odds_most);
}

TEST(ChooseReading, IsUnexpectedWhereTheFollowedReadingIsMissing) {
  const ChosenReading missing = chosen_of({reading_of(0.7, 3, 2500)});
  EXPECT_TRUE(missing.unexpected);
  EXPECT_FALSE(missing.turned);
}

TEST(ChooseReading, CountsOfAFollowedReadingNoMoreThanTheNoiseExplains) {
  PoseReading torn = reading_of(0, 300, 5);
  torn.explained_most = 20;
  const ChosenReading settled = chosen_of({torn, reading_of(0.7, 3, 2500)});
  EXPECT_EQ(settled.index, 0);
  EXPECT_DOUBLE_EQ(settled.odds, (3 + 5 + 40) - (20 + 5));
  const ChosenReading doubtful = chosen_of({torn, reading_of(0.7, 3, 2500)}, 5);
  EXPECT_EQ(doubtful.index, 1) << "the other one by 12";
  EXPECT_TRUE(doubtful.turned);
  EXPECT_DOUBLE_EQ(doubtful.odds, 12);
}

TEST(ChooseReading, WithoutAnotherReadingIsSurerFrameByFrame) {
  EXPECT_DOUBLE_EQ(chosen_of({reading_of(0, 3, 4)}, 5).odds, 5 + k_no_rival_worth);
  EXPECT_DOUBLE_EQ(chosen_of({reading_of(0, 3, 4), reading_of(0.01, 4, 4)}, 5).odds,
                   5 + k_no_rival_worth);
}

}  // namespace
}  // namespace glint::choose_reading_test
