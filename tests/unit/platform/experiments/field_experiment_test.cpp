#include "platform/experiments/field_experiment.hpp"

#include <gtest/gtest.h>

#include "tests/unit/platform/sensors/temporary_folder.hpp"

namespace glint {
namespace {

OutputErrors measured_errors(const SessionResult& run) {
  return run.by_rate->tools[0][0].of_measured;
}

// One device, by what its cell states of it and as if it were exact: the errors are larger, and the
// stated covariance holds them.
TEST(Field, StatesTheErrorsOfADeviceThatIsNotWhatItsCellStates) {
  const test::TemporaryFolder folder;
  const OutputErrors drawn =
      measured_errors(run_field_device(FieldDevice::drawn, 12, 8, folder.path("")));
  const OutputErrors exact =
      measured_errors(run_field_device(FieldDevice::exact, 12, 8, folder.path("")));
  ASSERT_GT(drawn.count, 500u);
  EXPECT_GT(drawn.square_m2 / static_cast<double>(drawn.count),
            2 * exact.square_m2 / static_cast<double>(exact.count));
  EXPECT_GT(drawn.inside_position, 0.9 * static_cast<double>(drawn.count));
  EXPECT_GT(drawn.stated_m2 / static_cast<double>(drawn.count),
            4 * drawn.random_m2 / static_cast<double>(drawn.count));
  EXPECT_DOUBLE_EQ(exact.stated_m2, exact.random_m2) << "an exact calibration leaves nothing open";
}

}  // namespace
}  // namespace glint
