#include "platform/budget/compare/budget_diff.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "platform/budget/compare/two_samples.hpp"
#include "platform/input_error.hpp"
#include "tests/unit/platform/budget/report/sample_files.hpp"

namespace glint {
namespace {

std::vector<double> draws(std::uint64_t seed, std::size_t count, double factor, double memory = 0) {
  std::mt19937_64 random(seed);
  std::vector<double> values;
  double last = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double u = static_cast<double>(random() >> 11) * 0x1p-53;
    last = memory * last + (u - 0.5);
    values.push_back(factor * (10 + last));
  }
  return values;
}

TEST(TwoSamples, ShowADifferenceOfAPercentInFourThousandTimes) {
  const auto a = draws(1, 4000, 1), b = draws(2, 4000, 1.02);
  EXPECT_LT(mann_whitney(a, b), 1e-6);
  const RatioInterval interval = median_ratio(a, b, 0.99, 500, 1);
  EXPECT_GT(interval.low, 1.0);
  EXPECT_LT(interval.low, 1.02);
  EXPECT_GT(interval.high, 1.02);
}

TEST(TwoSamples, ShowNoneWhereThereIsNone) {
  int shown = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto a = draws(2 * seed + 1, 300, 1), b = draws(2 * seed + 2, 300, 1);
    shown += mann_whitney(a, b) < 0.01 ? 1 : 0;
  }
  EXPECT_LE(shown, 8);  // 2 expected
}

// Autocorrelated times carry less information: resampling single values would be overconfident.
TEST(TwoSamples, WidenTheIntervalWhereTimesHangTogether) {
  const auto a = draws(3, 2000, 1, 0.9), b = draws(4, 2000, 1, 0.9);
  const RatioInterval together = median_ratio(a, b, 0.95, 400, 1);
  std::vector<double> mixed_a = a, mixed_b = b;
  std::mt19937_64 random(5);
  std::shuffle(mixed_a.begin(), mixed_a.end(), random);
  std::shuffle(mixed_b.begin(), mixed_b.end(), random);
  const RatioInterval apart = median_ratio(mixed_a, mixed_b, 0.95, 400, 1);
  EXPECT_GT(together.high - together.low, 1.5 * (apart.high - apart.low));
}

// Ranks by hand: a = {1, 2, 3}, b = {4, 5}: U = 0, mean 3, variance 3.
TEST(TwoSamples, RankAsByHand) {
  const double a[] = {1, 2, 3}, b[] = {4, 5};
  EXPECT_NEAR(mann_whitney(a, b), std::erfc(3 / std::sqrt(6.0)), 1e-12);
}

class Diff : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / ("diff_" + std::string(info->name()));
    std::filesystem::remove_all(folder_);
    write_samples((folder_ / "a").string(), {.frames = 400});
    write_samples((folder_ / "b").string(), {.frames = 400});
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string of(const char* name) const { return (folder_ / name).string(); }

  void change(const char* name, const std::string& kernel_bound, double factor) const {
    std::ifstream in(of(name));
    auto json = nlohmann::ordered_json::parse(in);
    auto& value = json["kernels"][1][kernel_bound];
    value = value.get<double>() * factor;
    std::ofstream(of(name)) << json.dump();
  }

  // Multiplies the duration of every span of one node by `factor`.
  void slow_down(const char* name, std::uint8_t node, double factor) const {
    TraceFile trace = read_trace(of(name));
    for (TraceSpan& span : trace.spans) {
      if (span.group != 0 || !is_node(span) || span.node != node) continue;
      span.end_ns = span.begin_ns + static_cast<std::int64_t>(
                                        factor * static_cast<double>(span.end_ns - span.begin_ns));
    }
    write_trace(of(name), trace);
  }

  std::filesystem::path folder_;
};

const DiffRow& row(const BudgetDiff& diff, const std::string& name) {
  for (const DiffRow& row : diff.rows) {
    if (row.name == name) return row;
  }
  throw std::runtime_error("no row " + name);
}

TEST_F(Diff, TellsOneInstructionMore) {
  change("b/measure.json", "bound", 1 + 1.0 / 402113);
  const BudgetDiff diff = budget_diff(of("a/measure.json"), of("b/measure.json"), {});
  EXPECT_TRUE(diff.exact);
  EXPECT_EQ(row(diff, "FindBlobs").change, Change::slower);
  EXPECT_EQ(row(diff, "PackCan").change, Change::same);
  EXPECT_TRUE(diff.worse());
  EXPECT_FALSE(
      budget_diff(of("a/measure.json"), of("b/measure.json"), {.tolerance_percent = 1}).worse());
}

TEST_F(Diff, SaysNothingBecameSlowerBetweenEqualRuns) {
  const BudgetDiff diff = budget_diff(of("a/run"), of("b/run"), {});
  EXPECT_EQ(diff.rows.size(), 17U);  // 16 nodes and the stage to the bus
  EXPECT_FALSE(diff.worse());
}

TEST_F(Diff, FindsTheOneNodeThatBecameSlower) {
  slow_down("b/run/trace.spans", 6, 1.1);
  const BudgetDiff diff = budget_diff(of("a/run"), of("b/run/trace.spans"), {});
  for (const DiffRow& r : diff.rows) {
    EXPECT_EQ(r.change, r.name == "frame FindBlobs" ? Change::slower : Change::not_significant)
        << r.name;
  }
  EXPECT_TRUE(diff.worse());
  EXPECT_FALSE(budget_diff(of("a/run"), of("b/run"), {.tolerance_percent = 20}).worse());
  EXPECT_EQ(row(budget_diff(of("b/run"), of("a/run"), {}), "frame FindBlobs").change,
            Change::faster);
}

TEST_F(Diff, ListsAKernelThatOnlyOneOfThemHas) {
  std::ifstream in(of("b/measure.json"));
  auto json = nlohmann::ordered_json::parse(in);
  json["kernels"].erase(0);
  std::ofstream(of("b/measure.json")) << json.dump();
  const BudgetDiff diff = budget_diff(of("a/measure.json"), of("b/measure.json"), {});
  EXPECT_EQ(diff.only_before, std::vector<std::string>{"RoiThreshold"});
}

TEST_F(Diff, ComparesOnlyLikeWithLike) {
  EXPECT_THROW((void)budget_diff(of("a/measure.json"), of("b/run"), {}), InputError);
  EXPECT_THROW((void)budget_diff(of("a/measure.json"), of("b/measure_time.json"), {}), InputError);
}

}  // namespace
}  // namespace glint
