#include "platform/lab/experiments/cis_pivot.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "kernels/motion/interpolate.hpp"
#include "platform/input_error.hpp"
#include "platform/sim/random.hpp"

namespace glint {
namespace {

CaseOptions options_for(const std::string& folder) {
  CaseOptions options;
  options.data = folder;
  return options;
}

double figure_of(const CaseList& list, const std::string& name) {
  for (const ExperimentCase& found : list.cases)
    if (found.name == name) return found.figures.front().value;
  ADD_FAILURE() << "no case " << name;
  return 0;
}

class CisPivot : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::TempDir() + "cis_pivot_" + std::to_string(getpid());
    std::filesystem::create_directories(folder_ + "/pa1");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::ofstream file(const std::string& name) const { return std::ofstream(folder_ + "/" + name); }

  // Writes a data set of a pointer with four markers, measured by both trackers; the optical
  // tracker's base is rotated.
  void write_case(const Vector3& em_mm, const Vector3& optical_mm, double answer_off_mm) const {
    const std::vector<Vector3> pointer{{0, 0, 90}, {40, 0, 120}, {0, 50, 150}, {-30, -20, 180}};
    const std::vector<Vector3> base{{0, 0, 0}, {0, 0, 150}, {0, 150, 0}};
    std::ofstream em = file("pa1/own-empivot.txt"), optical = file("pa1/own-optpivot.txt");
    em << "4, 20, own-empivot.txt\n";
    optical << "3, 4, 20, own-optpivot.txt\n";
    std::ofstream calbody = file("pa1/own-calbody.txt");
    calbody << "3, 0, 0, own-calbody.txt\n";
    for (const Vector3& b : base) calbody << b.x() << ", " << b.y() << ", " << b.z() << "\n";
    for (std::uint64_t f = 0; f < 20; ++f) {
      const Vector3 tilt = 0.4 * sim::gaussian_vector({1, sim::Stream::hand, 5}, f);
      const Quaternion turn = from_rotation_vector(tilt);
      const Pose T_tracker_base{from_rotation_vector(0.2 * tilt), {10, -20, -1500}};
      for (const Vector3& b : base) put(optical, T_tracker_base * b);
      for (const Vector3& p : pointer) {
        put(em, turn * p + em_mm);
        put(optical, T_tracker_base * (turn * p + optical_mm));
      }
    }
    std::ofstream answer = file("pa1/own-output1.txt");
    answer << "0, 0, own-output1.txt\n";
    put(answer, em_mm + Vector3(answer_off_mm, 0, 0));
    put(answer, optical_mm);
  }
  static void put(std::ofstream& out, const Vector3& p) {
    out.precision(12);
    out << p.x() << ", " << p.y() << ", " << p.z() << "\n";
  }

  std::string folder_;
};

TEST_F(CisPivot, FindsThePostsOfBothTrackers) {
  write_case({190, 200, 210}, {400, 390, 200}, 0);
  const CaseList list = run_cis_pivot(options_for(folder_));
  EXPECT_LT(figure_of(list, "own em"), 1e-6);
  EXPECT_LT(figure_of(list, "own optical"), 1e-6);
  EXPECT_EQ(missed_bars(list), 0);
}

TEST_F(CisPivot, MissesItsBarWhereTheAnswerIsAnother) {
  write_case({190, 200, 210}, {400, 390, 200}, 0.03);
  const CaseList list = run_cis_pivot(options_for(folder_));
  EXPECT_NEAR(figure_of(list, "own em"), 0.03, 1e-6);
  EXPECT_EQ(missed_bars(list), 1);
}

TEST_F(CisPivot, RefusesFilesThatAreCutShortAndFoldersWithoutCases) {
  EXPECT_THROW((void)run_cis_pivot(options_for(folder_)), InputError);
  write_case({190, 200, 210}, {400, 390, 200}, 0);
  file("pa1/own-empivot.txt") << "4, 20, own-empivot.txt\n1, 2, 3\n";
  EXPECT_THROW((void)run_cis_pivot(options_for(folder_)), InputError);
  file("pa1/own-empivot.txt") << "4, 20, own-empivot.txt\n1, two, 3\n";
  EXPECT_THROW((void)run_cis_pivot(options_for(folder_)), InputError);
}

TEST(CisPivotData, EqualsTheCourseAnswersWithin002Mm) {
  const char* data = std::getenv("GLINT_TEST_DATA");
  const std::string folder = std::string(data == nullptr ? "" : data) + "/cis_pivot";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder << "; set GLINT_TEST_DATA";
  const CaseList list = run_cis_pivot(options_for(folder));
  std::fputs(case_table(list).c_str(), stdout);
  EXPECT_EQ(missed_bars(list), 0);
  EXPECT_LE(figure_of(list, "all em posts"), 0.02);
  EXPECT_LE(figure_of(list, "all optical posts"), 0.02);
  EXPECT_LE(figure_of(list, "all two-body tips"), 0.02);
}

}  // namespace
}  // namespace glint
