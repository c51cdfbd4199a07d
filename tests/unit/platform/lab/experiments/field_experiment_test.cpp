#include "platform/lab/experiments/field_experiment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <memory>

#include "platform/input_error.hpp"
#include "platform/lab/experiments/field_calibration.hpp"
#include "platform/lab/experiments/field_runs.hpp"
#include "platform/sources/scenario_of.hpp"
#include "platform/sources/simulated_source.hpp"
#include "platform/tools/calibrate/headset.hpp"
#include "tests/unit/platform/formats/temporary_folder.hpp"
#include "tests/unit/platform/tools/calibrate/expect_message.hpp"

namespace glint {
namespace {

OutputErrors measured_errors(const SessionResult& run) {
  return run.by_rate->tools[0][0].of_measured;
}

// One device, drawn from its cell's stated uncertainties and as an exact device. The drawn device
// has larger errors, and the stated covariance covers them.
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

// A device after its user's calibrations. Each calibrated value is closer to the ground truth than
// before, within a few of its stated standard deviations.
TEST(Field, CalibrationsFindADevicesErrorsAndStateWhatTheyLeave) {
  const Cell drawn = field_cell(9, 30);
  const Cell cell = calibrated_field_cell(drawn, {8, 25, 16, 24, 20});
  const sim::Scenario device = scenario_of(drawn);
  const CameraUncertainty& stated = cell.camera.uncertainty;

  Vector2 off_px = Vector2::Zero();
  int rays = 0;
  for (double x = -0.4; x < 0.5; x += 0.2) {
    for (double y = -0.4; y < 0.5; y += 0.2) {
      const Vector3 ray(x, y, 1);
      const Vector2 ideal = project(drawn.camera.model, ray).value;
      const Vector2 middle(drawn.camera.model.cx, drawn.camera.model.cy);
      sim::DeviceErrors lens = device.device;
      lens.correlated_centroid_px = 0;
      off_px += project(cell.camera.model, ray).value - ideal -
                sim::marker_error(lens, ideal, middle, 0.5, 0, {}).shift_px;
      ++rays;
    }
  }
  EXPECT_LT(off_px.norm() / rays, 4 * stated.principal_point_px);
  EXPECT_LT(stated.principal_point_px, drawn.camera.uncertainty.principal_point_px);

  const auto range_error = [&](const Cell& known) {
    return device.device.range_offset_m + 0.5 * device.device.range_scale -
           known.camera.depth.bias.offset_m;
  };
  EXPECT_LT(std::abs(range_error(cell)), 4 * std::hypot(stated.range_offset_m, 0.001));
  EXPECT_LT(stated.range_offset_m, 0.5 * drawn.camera.uncertainty.range_offset_m);

  const sim::Scenario judged = scenario_of(cell, drawn);
  const Tool &made = judged.tools[0].tool, &tool = cell.tools.items[0];
  EXPECT_EQ(made.tip_m, tool.tip_m);
  double geometry_m2 = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(tool.marker_count); ++i) {
    const Vector3 off = tool.markers_m[i] - tool.middle_m() - made.markers_m[i] + made.middle_m();
    geometry_m2 += off.squaredNorm() / (3 * tool.marker_count);
  }
  EXPECT_LT(std::sqrt(geometry_m2), 4 * tool.marker_sigma_m);
  EXPECT_LT(tool.marker_sigma_m, drawn.tools.items[0].marker_sigma_m);
  EXPECT_LT((made.middle_m() - tool.middle_m()).norm(), 6 * tool.tip_sigma_m) << "the tip's error";

  const double drift =
      device.localisation.rest_position_m / sim::LocalisationSettings{}.rest_position_m;
  const double found = cell.head_noise.rest_position_m / drawn.head_noise.rest_position_m;
  EXPECT_GT(found, 0.7 * drift);
  EXPECT_LT(found, 2.5 * drift);
}

// After a power cut the incomplete line is run again; later complete lines are kept.
TEST(Field, RunsThatAreDoneAreNotDoneAgain) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("runs.txt");
  FieldRun run;
  run.device = FieldDevice::calibrated;
  run.duration_s = 30;
  run.measured.count = 1234;
  run.predicted.log_score = -1.0 / 3;
  for (const std::uint64_t seed : {7, 8, 9}) {
    run.seed = seed;
    if (seed == 8) {
      std::ofstream(path, std::ios::app) << "\n1 8 30 500 4";
      continue;
    }
    FinishedRuns(path).add(run);
  }
  const FinishedRuns read(path);
  const FieldRun* found = read.find(FieldDevice::calibrated, 9, 30);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->measured.count, 1234u);
  EXPECT_EQ(found->predicted.log_score, -1.0 / 3);
  EXPECT_NE(read.find(FieldDevice::calibrated, 7, 30), nullptr);
  EXPECT_EQ(read.find(FieldDevice::calibrated, 8, 30), nullptr);
  EXPECT_EQ(read.find(FieldDevice::oracle, 9, 30), nullptr);
  EXPECT_EQ(read.find(FieldDevice::calibrated, 9, 8), nullptr);
  EXPECT_THROW(FinishedRuns(folder.path("")).add(run), InputError);
}

TEST(Field, TheHeadsetsDriftNeedsAToolThatRestsInView) {
  Cell asked = field_cell(9, 5);
  asked.simulator.scenario = "field_board";
  const sim::Simulator nothing(scenario_of(asked));
  RecordedFrames recorded{"empty.mcap", asked, std::make_unique<SimulatedSource>(nothing)};
  test::expect_input_error([&] { (void)calibrate_headset(recorded, 0); },
                           {"empty.mcap", "in too few of", "lay the tool down"});
}

}  // namespace
}  // namespace glint
