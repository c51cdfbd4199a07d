#include "platform/experiments/warnings_experiment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>

#include "platform/cells/tool_file.hpp"
#include "platform/experiments/field_experiment.hpp"
#include "platform/session/simulated_run.hpp"
#include "platform/sources/scenario_of.hpp"

namespace glint {
namespace {

constexpr double k_warned_s = 30, k_warned_quick_s = 10;
constexpr double k_large_sigmas = 4;

enum class Large { nothing, range_offset, tool_geometry, principal_point, focal_length };
struct WarningCase {
  const char* name;
  Large large;
  int seeds, quick;
  Bar bar;
};
constexpr int k_warning_case_count = 5;
const std::array<WarningCase, k_warning_case_count> k_warning_cases = {
    WarningCase{"every error below one sigma", Large::nothing, 40, 2, Bar::at_most(2)},
    WarningCase{"range offset at four sigma", Large::range_offset, 20, 1, Bar::at_least(16)},
    WarningCase{"tool geometry at four sigma", Large::tool_geometry, 20, 1, Bar::at_least(16)},
    WarningCase{"principal point at four sigma", Large::principal_point, 20, 1, Bar::at_least(14)},
    WarningCase{"focal length at four sigma", Large::focal_length, 20, 1, Bar::at_least(14)}};

// Even, below one sigma; the scenario's own draws are of the stated distributions.
void shrink_errors(const Cell& cell, Large large, std::uint64_t seed, sim::Scenario& scenario) {
  std::mt19937_64 random(seed);
  const auto even = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  const auto normal = [&] { return std::normal_distribution<double>()(random); };
  const CameraUncertainty& stated = cell.camera.uncertainty;
  sim::DeviceErrors& device = scenario.device;
  device.principal_point_px.x() = stated.principal_point_px * even();
  device.principal_point_px.y() = stated.principal_point_px * even();
  device.focal_scale = stated.focal_scale * even();
  device.range_scale = stated.range_scale * even();
  device.range_offset_m = stated.range_offset_m * even();
  if (large == Large::range_offset)
    device.range_offset_m = (even() > 0 ? 1 : -1) * k_large_sigmas * stated.range_offset_m;
  if (large == Large::principal_point) {
    const double angle = 3.1415926535897932 * even();
    device.principal_point_px =
        k_large_sigmas * stated.principal_point_px * Vector2(std::cos(angle), std::sin(angle));
  }
  if (large == Large::focal_length)
    device.focal_scale = (even() > 0 ? 1 : -1) * k_large_sigmas * stated.focal_scale;
  scenario.timing.stamp_offset = {static_cast<std::int64_t>(1e9 * stated.stamp_s * even())};
  for (std::size_t t = 0; t < scenario.tools.size(); ++t) {
    Tool& made = scenario.tools[t].tool;
    const Tool& drawn = cell.tools.items[t];
    for (std::size_t i = 0; i < static_cast<std::size_t>(made.marker_count); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const double sigmas = large == Large::tool_geometry ? k_large_sigmas * normal() : even();
        made.markers_m[i](axis) = drawn.markers_m[i](axis) + sigmas * drawn.marker_sigma_m;
      }
    }
  }
}

// Fixed to the table.
void add_reference_body(Cell& cell) {
  cell.reference = cell.tools.count;
  cell.tools.items[static_cast<std::size_t>(cell.tools.count++)] = reference_board();
}

std::vector<CalibrationFinding> findings_of(Large large, std::uint64_t seed, double duration_s,
                                            const std::string& out) {
  Cell cell = field_cell(seed, duration_s);
  if (large == Large::principal_point || large == Large::focal_length) add_reference_body(cell);
  sim::Scenario scenario = scenario_of(cell);
  shrink_errors(cell, large, seed, scenario);
  SessionOptions options;
  options.out = out;
  return run_simulated(cell, std::move(scenario), options).calibration;
}

bool is_of(ErrorSource found, Large large) {
  switch (large) {
    case Large::nothing:
      return true;
    case Large::range_offset:
      return found == ErrorSource::range_offset || found == ErrorSource::range;
    case Large::tool_geometry:
      return found == ErrorSource::tool_geometry;
    case Large::principal_point:
      return found == ErrorSource::principal_point;
    case Large::focal_length:
      return found == ErrorSource::focal_length;
  }
  return false;
}

}  // namespace

CaseList run_warnings(const CaseOptions& options) {
  CaseList list{"warnings", {}, {}};
  int done = 0, all = 0;
  for (const WarningCase& one : k_warning_cases) all += options.quick ? one.quick : one.seeds;
  for (const WarningCase& one : k_warning_cases) {
    const int seeds = options.quick ? one.quick : one.seeds;
    int named = 0, others = 0;
    double sigmas = 0;  // of the case's source, the largest
    for (int i = 0; i < seeds; ++i) {
      const auto findings = findings_of(one.large, options.seed + static_cast<std::uint64_t>(i),
                                        options.quick ? k_warned_quick_s : k_warned_s, options.out);
      bool this_named = false, other_named = false;
      for (const CalibrationFinding& finding : findings) {
        const bool right = is_of(finding.source, one.large);
        if (right) sigmas = std::max(sigmas, finding.stated_sigmas);
        this_named = this_named || (right && finding.named);
        other_named = other_named || (!right && finding.named);
      }
      named += this_named ? 1 : 0;
      others += other_named ? 1 : 0;
      if (options.progress) options.progress(++done, all);
    }
    list.cases.push_back(
        {one.name,
         "glint",
         seeds,
         {{"runs_named", "", static_cast<double>(named), options.quick ? Bar::none() : one.bar},
          {"runs_another_named", "", static_cast<double>(others)},
          {"largest_size", "sigmas", sigmas}}});
  }
  return list;
}

}  // namespace glint
