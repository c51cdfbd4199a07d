#include "platform/lab/experiments/anchored_experiment.hpp"

#include <gtest/gtest.h>

#include "platform/lab/experiments/experiment.hpp"

namespace glint::anchored_experiment_test {
namespace {

TEST(AnchoredExperiment, HoldsEveryHeadsetToTheBoard) {
  CaseOptions options;
  options.quick = true;
  options.seed = 60;
  const CaseList list = run_drift_correction(options);
  ASSERT_EQ(list.cases.size(), 6u);
  for (std::size_t i = 0; i < list.cases.size(); ++i) {
    const ExperimentCase& one = list.cases[i];
    const ExperimentBars bars = bars_of(i < 3 ? ExperimentKind::still : ExperimentKind::moving);
    EXPECT_GT(one.n, 50) << one.name;
    EXPECT_LT(one.figures[0].value, bars.position_mm) << one.name;
    EXPECT_LT(one.figures[1].value, bars.angle_deg) << one.name;
    EXPECT_GT(one.figures[2].value, 75) << one.name << ": inside the stated 95 %, of 60 frames";
  }
}

}  // namespace
}  // namespace glint::anchored_experiment_test
