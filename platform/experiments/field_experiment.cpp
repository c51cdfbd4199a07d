#include "platform/experiments/field_experiment.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "kernels/angles.hpp"
#include "platform/session/simulated_run.hpp"
#include "platform/sources/scenario_of.hpp"

namespace glint {
namespace {

constexpr int k_seeds = 40, k_seeds_quick = 2;
constexpr double k_duration_s = 30, k_duration_quick_s = 8;
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

struct Tally {
  std::uint64_t ticks = 0;
  OutputErrors measured, predicted;
  std::int64_t trackable = 0, fresh = 0, gross_fits = 0;
  int seeds_low = 0;

  void add(const SessionResult& run) {
    OutputErrors of_seed;
    for (const RateFigures& rate : run.by_rate->tools[0]) {
      ticks += rate.ticks;
      measured = sum_of(measured, rate.of_measured);
      predicted = sum_of(predicted, rate.of_predicted);
      of_seed = sum_of(of_seed, sum_of(rate.of_measured, rate.of_predicted));
    }
    seeds_low += percent(of_seed.inside_position, of_seed.count) < k_seed_coverage_low ? 1 : 0;
    trackable += run.accuracy.trackable;
    fresh += run.accuracy.tracked;
    gross_fits += run.accuracy.gross;
  }
  static double percent(std::uint64_t part, std::uint64_t all) {
    return all > 0 ? 100 * static_cast<double>(part) / static_cast<double>(all) : 0;
  }
};

ExperimentCase judged(FieldDevice device, const CaseOptions& options, int& done) {
  const int seeds = options.quick ? k_seeds_quick : k_seeds;
  const double duration_s = options.quick ? k_duration_quick_s : k_duration_s;
  Tally tally;
  for (int i = 0; i < seeds; ++i) {
    const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(i);
    tally.add(run_field_device(device, seed, duration_s, options.out));
    if (options.progress) options.progress(++done, 2 * seeds);
  }
  const bool drawn = device == FieldDevice::drawn;
  const auto bar = [&](const Bar& limit) { return drawn && !options.quick ? limit : Bar::none(); };
  const OutputErrors all = sum_of(tally.measured, tally.predicted);
  const double n = static_cast<double>(all.count);
  const double tip_m = std::sqrt(all.square_m2 / n), stated_m = std::sqrt(all.stated_m2 / n);
  const double angle = std::sqrt(all.square_rad2 / n), stated = std::sqrt(all.stated_rad2 / n);
  return {drawn ? "uncalibrated devices" : "the same without their errors",
          "glint",
          static_cast<std::int64_t>(all.count),
          {{"coverage_tip", "%", Tally::percent(all.inside_position, all.count),
            bar(Bar::at_least(k_coverage_min))},
           {"coverage_angle", "%", Tally::percent(all.inside_rotation, all.count),
            bar(Bar::at_least(k_coverage_min))},
           {"tip_rms", "mm", 1e3 * tip_m},
           {"tip_stated_by_rms", "", stated_m / tip_m, bar(Bar::at_most(k_sharpness_max))},
           {"angle_rms", "deg", k_degrees_per_radian * angle},
           {"angle_stated_by_rms", "", stated / angle, bar(Bar::at_most(k_sharpness_max))},
           {"log_score", "nat", all.log_score / n},
           {"gross_measured", "", static_cast<double>(tally.measured.gross), bar(Bar::at_most(0))},
           {"gross_predicted", "%", Tally::percent(tally.predicted.gross, tally.ticks),
            bar(Bar::at_most(0.1))},
           {"gross_fits", "", static_cast<double>(tally.gross_fits)},
           {"fresh", "%",
            Tally::percent(static_cast<std::uint64_t>(tally.fresh),
                           static_cast<std::uint64_t>(tally.trackable)),
            bar(Bar::at_least(97))},
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
                               const std::string& out) {
  Cell cell = field_cell(seed, duration_s);
  sim::Scenario scenario = scenario_of(cell);
  if (device == FieldDevice::exact) {
    build_exactly(cell, scenario);
    state_exactly(cell);
  }
  SessionOptions options;
  options.out = out;
  return run_simulated(cell, std::move(scenario), options);
}

CaseList run_field(const CaseOptions& options) {
  CaseList list{"field", {}, {}};
  int done = 0;
  for (const FieldDevice device : {FieldDevice::drawn, FieldDevice::exact})
    list.cases.push_back(judged(device, options, done));
  return list;
}

}  // namespace glint
