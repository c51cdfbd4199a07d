#include "platform/lab/experiments/reference_tries.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace glint {
namespace {

TryResult try_of(int number, const std::string& verdict, double translation_mm,
                 double rotation_deg) {
  return {3,
          number,
          verdict,
          translation_mm,
          rotation_deg,
          4.5,
          1.25,
          verdict == "accepted" ? "" : "a, b"};
}

int class_of(TryFault fault) {
  const std::vector<TryClass>& classes = try_classes();
  for (std::size_t c = 0; c < classes.size(); ++c) {
    if (classes[c].fault == fault) return static_cast<int>(c);
  }
  return -1;
}

double figure(const CaseList& list, const std::string& name) {
  for (const Figure& one : list.cases.at(0).figures) {
    if (one.name == name) return one.value;
  }
  return -1;
}

TEST(ReferenceTries, ReadsFinishedTriesOfItsRandomSeedAndNoLineThatIsCutShort) {
  const std::string path = ::testing::TempDir() + "glint_tries.csv";
  TryResult other = try_of(1, "accepted", 1, 1);
  other.seed = 4;
  const std::string cut = try_line(try_of(2, "accepted", 1, 1));
  std::ofstream(path) << try_line(try_of(0, "refused", 700.5, 12.25)) << try_line(other)
                      << cut.substr(0, cut.size() - 1);
  const std::vector<TryResult> tries = read_tries(path, 3);
  std::filesystem::remove(path);
  ASSERT_EQ(tries.size(), 1u);
  EXPECT_EQ(tries[0].number, 0);
  EXPECT_EQ(tries[0].verdict, "refused");
  EXPECT_EQ(tries[0].translation_mm, 700.5);
  EXPECT_EQ(tries[0].rotation_deg, 12.25);
  EXPECT_EQ(tries[0].cpu_s, 1.25);
  EXPECT_EQ(tries[0].reason, "a, b");
}

TEST(ReferenceTries, CountsAWrongPoseOnlyIfItWasAccepted) {
  const int step = static_cast<int>(try_classes().size());
  const CaseList list =
      count_tries({try_of(0, "accepted", 24, 4), try_of(step, "accepted", 40, 4),
                   try_of(2 * step, "refused", 700, 100), try_of(3 * step, "ambiguous", 51, 4)});
  ASSERT_EQ(list.cases.size(), 1u);
  EXPECT_EQ(list.cases[0].n, 4);
  EXPECT_EQ(figure(list, "wrong_accepted"), 0);
  EXPECT_EQ(figure(list, "between_accepted"), 1);
  EXPECT_EQ(figure(list, "accepted"), 50);
  EXPECT_EQ(figure(list, "ambiguous"), 25);
  EXPECT_EQ(figure(count_tries({try_of(0, "accepted", 51, 4)}), "wrong_accepted"), 1);
  EXPECT_EQ(figure(count_tries({try_of(0, "accepted", 2, 11)}), "wrong_accepted"), 1);
}

TEST(ReferenceTries, CountsEveryPoseOfARobotThatIsNotThereAsWrong) {
  for (const TryFault fault : {TryFault::robot, TryFault::cut_out}) {
    const CaseList list = count_tries({try_of(class_of(fault), "accepted", 1, 1)});
    EXPECT_EQ(figure(list, "wrong_accepted"), 1);
    EXPECT_EQ(missed_bars(list), 1);
  }
  EXPECT_EQ(
      figure(count_tries({try_of(class_of(TryFault::joints), "accepted", 1, 1)}), "wrong_accepted"),
      0);
}

}  // namespace
}  // namespace glint
