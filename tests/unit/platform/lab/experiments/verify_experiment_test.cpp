#include "platform/lab/experiments/verify_experiment.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "platform/lab/experiments/field_experiment.hpp"
#include "platform/lab/experiments/stated_errors.hpp"
#include "platform/sources/scenario_of.hpp"

namespace glint::verify_experiment_test {
namespace {

TEST(StatedErrors, AreBelowOneSigmaButForTheLargeOne) {
  const CameraUncertainty stated;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Cell cell = field_cell(seed, 30);
    const auto drawn = [&](LargeError large) {
      sim::Scenario scenario = scenario_of(cell);
      draw_below_one_sigma(cell, large, seed, scenario);
      return scenario.device;
    };
    const sim::DeviceErrors small = drawn(LargeError::nothing);
    EXPECT_LE(std::abs(small.range_offset_m), stated.range_offset_m);
    EXPECT_LE(std::abs(small.range_scale), stated.range_scale);
    EXPECT_LE(std::abs(small.focal_scale), stated.focal_scale);
    EXPECT_LE(small.principal_point_px.cwiseAbs().maxCoeff(), stated.principal_point_px);
    EXPECT_DOUBLE_EQ(std::abs(drawn(LargeError::range_offset).range_offset_m),
                     k_large_sigmas * stated.range_offset_m);
    EXPECT_DOUBLE_EQ(std::abs(drawn(LargeError::range_scale).range_scale),
                     k_large_sigmas * stated.range_scale);
    EXPECT_NEAR(drawn(LargeError::principal_point).principal_point_px.norm(),
                k_large_sigmas * stated.principal_point_px, 1e-9);
  }
}

// One device per case. The first is drawn from the stated distributions, of which one in 20 is
// refused by chance.
TEST(VerifyExperiment, JudgesSmallAndLargeErrors) {
  CaseOptions options;
  options.quick = true;
  options.seed = 11;
  const CaseList list = run_verify_experiment(options);
  ASSERT_EQ(list.cases.size(), 3u);
  for (const ExperimentCase& one : list.cases) {
    EXPECT_EQ(one.n, 1) << one.name;
    EXPECT_EQ(one.figures[0].name, "wrong_verdicts");
  }
  EXPECT_EQ(list.cases[1].figures[0].value, 0) << list.cases[1].name;
  EXPECT_EQ(list.cases[2].figures[0].value, 0) << list.cases[2].name;
}

}  // namespace
}  // namespace glint::verify_experiment_test
