#include "platform/lab/experiments/field_experiment.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "kernels/angles.hpp"
#include "platform/lab/experiments/field_calibration.hpp"
#include "platform/lab/experiments/field_runs.hpp"
#include "platform/lab/experiments/recordings.hpp"
#include "platform/runtime/session/simulated_run.hpp"
#include "platform/sources/scenario_of.hpp"

namespace glint {
namespace {

constexpr int k_field_seeds = 40, k_field_seeds_quick = 2;
constexpr CalibrationSeconds k_quick_calibrations{8, 20, 20, 30, 25};
constexpr double k_duration_s = 30, k_duration_quick_s = 8;
constexpr std::uint64_t k_real_background = 4;  // of so many devices one
constexpr double k_coverage_min = 88, k_sharpness_max = 3;
constexpr double k_seed_coverage_low = 80;

void state_exactly(Cell& cell) {
  cell.camera.uncertainty = k_exact_camera;
  cell.robot_sigma_m = cell.robot_sigma_rad = 0;
  for (Tool& tool : cell.tools.items) tool.marker_sigma_m = tool.tip_sigma_m = 0;
}

// The scenario's motion, noise and events without what the device differs by.
void build_exactly(const Cell& cell, sim::Scenario& scenario) {
  const sim::Scenario plain = sim::Scenario{};
  scenario.device = {};
  scenario.timing.stamp_offset = {};
  scenario.localisation = plain.localisation;
  for (std::size_t i = 0; i < scenario.tools.size(); ++i)
    scenario.tools[i].tool = cell.tools.items[i];
}

// The errors that are constant are corrected; those that are not are stated as drawn.
void correct_all(sim::Scenario& scenario, Cell& cell) {
  const sim::LocalisationSettings drawn = scenario.localisation, declared;
  const double drift = drawn.rest_position_m / declared.rest_position_m;
  sim::DeviceErrors left = scenario.device;
  left.principal_point_px = Vector2::Zero();
  left.focal_scale = left.lens_residual_px = 0;
  left.range_offset_m = left.range_scale = left.range_wiggle_m = left.dim_m = 0;
  const CameraUncertainty shipped = cell.camera.uncertainty;
  state_exactly(cell);
  cell.camera.uncertainty.correlated_range_m = shipped.correlated_range_m;
  cell.camera.uncertainty.correlated_centroid_px = shipped.correlated_centroid_px;
  cell.camera.uncertainty.fast_share = shipped.fast_share;
  build_exactly(cell, scenario);
  scenario.device = left;
  scenario.localisation = drawn;
  scenario.localisation.latency_s = 0;
  scenario.localisation.T_stated_world.reset();
  HeadNoise& stated = cell.head_noise;
  for (double* part :
       {&stated.rest_position_m, &stated.rest_angle_rad, &stated.position_per_speed_s,
        &stated.position_per_turn_m, &stated.angle_per_speed_s_m, &stated.angle_per_turn_s})
    *part *= drift;
  stated.time_stamp_s = 0;
}

OutputErrors sum_of(const OutputErrors& a, const OutputErrors& b) {
  OutputErrors sum = a;
  sum.count += b.count;
  sum.inside_position += b.inside_position;
  sum.inside_rotation += b.inside_rotation;
  sum.gross += b.gross;
  sum.square_m2 += b.square_m2;
  sum.square_rad2 += b.square_rad2;
  sum.stated_m2 += b.stated_m2;
  sum.stated_rad2 += b.stated_rad2;
  sum.log_score += b.log_score;
  return sum;
}

FieldRun run_of(FieldDevice device, std::uint64_t seed, double duration_s,
                const SessionResult& result) {
  FieldRun run;
  run.device = device;
  run.seed = seed;
  run.duration_s = duration_s;
  for (const RateStatistics& rate : result.by_rate->tools[0]) {
    run.ticks += rate.ticks;
    run.measured = sum_of(run.measured, rate.of_measured);
    run.predicted = sum_of(run.predicted, rate.of_predicted);
  }
  run.trackable = result.accuracy.trackable;
  run.fresh = result.accuracy.tracked;
  run.gross_fits = result.accuracy.gross;
  return run;
}

struct Tally {
  std::uint64_t ticks = 0;
  OutputErrors measured, predicted;
  std::int64_t trackable = 0, fresh = 0, gross_fits = 0;
  int seeds = 0, seeds_low = 0;

  void add(const FieldRun& run) {
    const OutputErrors of_seed = sum_of(run.measured, run.predicted);
    ++seeds;
    ticks += run.ticks;
    measured = sum_of(measured, run.measured);
    predicted = sum_of(predicted, run.predicted);
    seeds_low += percent(of_seed.inside_position, of_seed.count) < k_seed_coverage_low ? 1 : 0;
    trackable += run.trackable;
    fresh += run.fresh;
    gross_fits += run.gross_fits;
  }
  static double percent(std::uint64_t part, std::uint64_t all) {
    return all > 0 ? 100 * static_cast<double>(part) / static_cast<double>(all) : 0;
  }
};

const char* name_of(FieldDevice device) {
  switch (device) {
    case FieldDevice::drawn:
      return "uncalibrated devices";
    case FieldDevice::calibrated:
      return "calibrated devices";
    case FieldDevice::oracle:
      return "the same, an oracle";
    default:
      return "the same without their errors";
  }
}

// What the figures of one kind of device have to meet.
struct FieldBars {
  Bar coverage_least = Bar::none(), coverage_most = Bar::none();
  Bar sharpness = Bar::none(), gross_measured = Bar::none(), gross_predicted = Bar::none(),
      fresh = Bar::none();
};

FieldBars bars_of(FieldDevice device) {
  if (device == FieldDevice::drawn)
    return {Bar::at_least(k_coverage_min),
            Bar::none(),
            Bar::at_most(k_sharpness_max),
            Bar::none(),
            Bar::none(),
            Bar::none()};
  if (device == FieldDevice::calibrated)
    return {Bar::at_least(92), Bar::at_most(98),  Bar::at_most(1.5),
            Bar::at_most(0),   Bar::at_most(0.1), Bar::at_least(97)};
  return {};
}

ExperimentCase case_of(FieldDevice device, const Tally& tally, const FieldBars& bars) {
  const OutputErrors all = sum_of(tally.measured, tally.predicted);
  const double n = static_cast<double>(all.count);
  const double tip_m = std::sqrt(all.square_m2 / n), stated_m = std::sqrt(all.stated_m2 / n);
  const double angle = std::sqrt(all.square_rad2 / n), stated = std::sqrt(all.stated_rad2 / n);
  const double inside_tip = Tally::percent(all.inside_position, all.count);
  const double inside_angle = Tally::percent(all.inside_rotation, all.count);
  return {name_of(device),
          "glint",
          static_cast<std::int64_t>(all.count),
          {{"seeds", "", static_cast<double>(tally.seeds)},
           {"coverage_tip", "%", inside_tip, bars.coverage_least},
           {"coverage_angle", "%", inside_angle, bars.coverage_least},
           {"coverage_most", "%", std::max(inside_tip, inside_angle), bars.coverage_most},
           {"tip_rms", "mm", 1e3 * tip_m},
           {"tip_stated_by_rms", "", stated_m / tip_m, bars.sharpness},
           {"angle_rms", "deg", k_degrees_per_radian * angle},
           {"angle_stated_by_rms", "", stated / angle, bars.sharpness},
           {"log_score", "nat", all.log_score / n},
           {"gross_measured", "", static_cast<double>(tally.measured.gross), bars.gross_measured},
           {"gross_predicted", "%", Tally::percent(tally.predicted.gross, tally.ticks),
            bars.gross_predicted},
           {"gross_fits", "", static_cast<double>(tally.gross_fits)},
           {"fresh", "%",
            Tally::percent(static_cast<std::uint64_t>(tally.fresh),
                           static_cast<std::uint64_t>(tally.trackable)),
            bars.fresh},
           {"seeds_below_80", "", static_cast<double>(tally.seeds_low)}}};
}

}  // namespace

Cell field_cell(std::uint64_t seed, double duration_s) {
  Cell cell = default_cell();
  cell.simulator.scenario = "field";
  cell.simulator.seed = seed;
  cell.simulator.duration_s = duration_s;
  cell.realtime = false;
  cell.workers = 1;
  cell.dds.on = false;
  cell.record.file.clear();
  cell.files = {};
  return cell;
}

SessionResult run_field_device(FieldDevice device, std::uint64_t seed, double duration_s,
                               const std::string& out, const sim::BackgroundFrame& background) {
  const Cell drawn = field_cell(seed, duration_s);
  Cell cell = drawn;
  sim::Scenario scenario = scenario_of(drawn);
  if (device == FieldDevice::calibrated) {
    cell = calibrated_field_cell(
        drawn, duration_s < k_duration_s ? k_quick_calibrations : CalibrationSeconds{});
    scenario = scenario_of(cell, drawn);
  }
  if (device == FieldDevice::oracle) correct_all(scenario, cell);
  if (device == FieldDevice::exact) {
    build_exactly(cell, scenario);
    state_exactly(cell);
  }
  scenario.background = background;
  SessionOptions options;
  options.out = out;
  return run_simulated(cell, std::move(scenario), options);
}

CaseList run_field(const CaseOptions& options) {
  const bool calibrated = options.tries > 0;
  const int asked = calibrated ? options.tries : k_field_seeds;
  const int quick = calibrated ? 1 : k_field_seeds_quick;
  const int seeds = options.quick ? quick : asked;
  const double duration_s = options.quick ? k_duration_quick_s : k_duration_s;
  const std::vector<FieldDevice> devices =
      calibrated ? std::vector{FieldDevice::calibrated, FieldDevice::oracle}
                 : std::vector{FieldDevice::drawn, FieldDevice::exact};
  sim::BackgroundFrame real, room;
  if (!options.data.empty()) real = load_hands_and_drill(options.data);
  // Runs before the real frame are other runs.
  FinishedRuns finished(options.out +
                        (real.range_m.empty() ? "/field_runs.txt" : "/field_runs_real.txt"));
  std::vector<Tally> tallies(devices.size());
  int done = 0;
  for (int i = 0; i < seeds; ++i) {
    const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(i);
    const sim::BackgroundFrame& background = seed % k_real_background == 0 ? real : room;
    for (std::size_t d = 0; d < devices.size(); ++d) {
      tallies[d].add(options.piece([&] {
        const FieldRun* run = calibrated ? finished.find(devices[d], seed, duration_s) : nullptr;
        if (run != nullptr) return *run;
        const FieldRun fresh =
            run_of(devices[d], seed, duration_s,
                   run_field_device(devices[d], seed, duration_s, options.out, background));
        return calibrated ? finished.add(fresh) : fresh;
      }));
      if (options.progress) options.progress(++done, static_cast<int>(devices.size()) * seeds);
    }
  }
  CaseList list{"field", {}, {}};
  for (std::size_t d = 0; d < devices.size(); ++d)
    list.cases.push_back(
        case_of(devices[d], tallies[d], options.quick ? FieldBars{} : bars_of(devices[d])));
  return list;
}

}  // namespace glint
