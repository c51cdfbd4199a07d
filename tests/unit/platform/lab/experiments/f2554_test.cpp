#include "platform/lab/experiments/f2554.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

namespace glint {
namespace {

TEST(F2554, JudgesOnePointThreeTurnsAndDistancesTheSameAgain) {
  CaseOptions options;
  options.quick = true;
  options.out = testing::TempDir() + "f2554_" + std::to_string(getpid());
  std::filesystem::create_directories(options.out);
  int last = 0, total = 0;
  options.progress = [&](int done, int all) {
    last = done;
    total = all;
  };
  const CaseList first = run_f2554(options);
  const CaseList again = run_f2554(options);
  ASSERT_EQ(first.cases.size(), 5u);
  EXPECT_EQ(last, total);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_GE(first.cases[i].n, 10) << first.cases[i].name;
    for (std::size_t f = 0; f < first.cases[i].figures.size(); ++f) {
      EXPECT_EQ(first.cases[i].figures[f].value, again.cases[i].figures[f].value);
    }
    // The range noise is 1.5 mm, so errors are millimetres: not zero, and not those of a wrong
    // tool.
    EXPECT_GT(first.cases[i].figures[1].value, 0.1);
    EXPECT_LT(first.cases[i].figures[1].value, 10);
  }
  EXPECT_NE(first.plots.at(0).svg.find("<svg"), std::string::npos);
  std::filesystem::remove_all(options.out);
}

}  // namespace
}  // namespace glint
