#include "platform/lab/experiments/case_list.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "platform/lab/experiments/case_experiments.hpp"
#include "platform/lab/experiments/estimator_settings.hpp"

namespace glint {
namespace {

CaseList two_figures(double rms_mm, double found) {
  return {"made up",
          {{"one case",
            "glint",
            42,
            {{"rms", "mm", rms_mm, Bar::at_most(2)}, {"found", "", found, Bar::at_least(0.99)}}},
           {"one case", "svd", 42, {{"rms", "mm", 99}}}},
          {}};
}

TEST(CaseList, CountsEveryFigureBeyondItsBarAndNoOther) {
  EXPECT_EQ(missed_bars(two_figures(2, 0.99)), 0);
  EXPECT_EQ(missed_bars(two_figures(2.01, 0.99)), 1);
  EXPECT_EQ(missed_bars(two_figures(2.01, 0.98)), 2);
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(missed_bars(two_figures(nothing, nothing)), 2);
}

TEST(CaseList, ShowsBarsAndSaysWhatMissesThem) {
  const std::string good = case_table(two_figures(1.5, 1)), bad = case_table(two_figures(3, 1));
  EXPECT_NE(good.find("rms 1.5 mm (<= 2)"), std::string::npos) << good;
  EXPECT_EQ(good.find("MISSED"), std::string::npos) << good;
  EXPECT_NE(bad.find("rms 3 mm (<= 2) MISSED"), std::string::npos) << bad;
  EXPECT_EQ(bad.find("rms 99 mm MISSED"), std::string::npos) << bad;  // a baseline has no limit
}

TEST(CaseList, GivesTheTablesFiguresAsJsonWithTheEstimatorsName) {
  const auto json = nlohmann::json::parse(case_json(two_figures(3, 1), {}));
  EXPECT_EQ(json["config_hash"], estimator_hash());
  EXPECT_EQ(json["missed"], 1);
  const auto& figures = json["cases"][0]["figures"];
  EXPECT_EQ(figures["rms"]["value"], 3);
  EXPECT_EQ(figures["rms"]["bar"]["at_most"], 2);
  EXPECT_EQ(figures["rms"]["met"], false);
  EXPECT_EQ(figures["found"]["met"], true);
  EXPECT_TRUE(json["cases"][1]["figures"]["rms"]["met"].is_null());
}

TEST(CaseExperiments, HaveNamesOfTheirOwn) {
  std::set<std::string> names = {"static", "dynamic"};
  for (const CaseExperiment& experiment : case_experiments()) {
    EXPECT_TRUE(names.insert(experiment.name).second) << experiment.name;
    EXPECT_NE(experiment.run, nullptr) << experiment.name;
  }
}

}  // namespace
}  // namespace glint
