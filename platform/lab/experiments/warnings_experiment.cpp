#include "platform/lab/experiments/warnings_experiment.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "platform/cells/tool_file.hpp"
#include "platform/lab/experiments/field_experiment.hpp"
#include "platform/lab/experiments/stated_errors.hpp"
#include "platform/runtime/session/simulated_run.hpp"
#include "platform/sim/hand_motion.hpp"
#include "platform/sources/scenario_of.hpp"

namespace glint {
namespace {

constexpr double k_warned_s = 30, k_warned_quick_s = 10;
struct WarningCase {
  const char* name;
  LargeError large;
  bool body;  // a static reference body is in view
  int seeds, quick_seeds;
  Bar bar;
};
constexpr int k_warning_case_count = 8;
constexpr int k_large_error_seeds = 20, k_small_error_seeds = 40;
const std::array<WarningCase, k_warning_case_count> k_warning_cases = {
    WarningCase{"below one sigma", LargeError::nothing, false, k_small_error_seeds, 2,
                Bar::at_most(2)},
    WarningCase{"below one sigma, body", LargeError::nothing, true, k_small_error_seeds, 2,
                Bar::at_most(2)},
    WarningCase{"range offset", LargeError::range_offset, false, k_large_error_seeds, 1,
                Bar::at_least(16)},
    WarningCase{"tool geometry", LargeError::tool_geometry, false, k_large_error_seeds, 1,
                Bar::at_least(16)},
    WarningCase{"principal point, body", LargeError::principal_point, true, k_large_error_seeds, 1,
                Bar::at_least(14)},
    WarningCase{"focal length, body", LargeError::focal_length, true, k_large_error_seeds, 1,
                Bar::at_least(14)},
    WarningCase{"time offset, body", LargeError::time_offset, true, k_large_error_seeds, 1,
                Bar::at_least(14)},
    WarningCase{"headset drift, body", LargeError::head_drift, true, k_large_error_seeds, 1,
                Bar::at_least(14)}};

// Slow look around: the body moves across the image, which makes lens errors observable.
sim::HeadSettings moving_head() {
  sim::HeadSettings head;
  head.target_m = Vector3(0.44, 0, -0.2);
  head.sway_rms_m = 0.1;
  head.gaze_rms_rad = 0.25;
  head.fastest_hz = 0.15;
  return head;
}

// Adds a reference body, fixed to the table.
void add_reference_body(Cell& cell) {
  cell.reference = cell.tools.count;
  cell.tools.items[static_cast<std::size_t>(cell.tools.count++)] = reference_body();
}

std::vector<CalibrationFinding> findings_of(const WarningCase& one, std::uint64_t seed,
                                            double duration_s, const std::string& out) {
  Cell cell = field_cell(seed, duration_s);
  if (one.body) add_reference_body(cell);
  sim::Scenario scenario = scenario_of(cell);
  if (one.body) scenario.head = sim::head_motion(moving_head(), seed);
  draw_below_one_sigma(cell, one.large, seed, scenario);
  SessionOptions options;
  options.out = out;
  return run_simulated(cell, std::move(scenario), options).calibration;
}

bool matches(ErrorSource found, LargeError large) {
  switch (large) {
    case LargeError::nothing:
      return true;
    case LargeError::range_offset:
      return found == ErrorSource::range_offset || found == ErrorSource::range;
    case LargeError::tool_geometry:
      return found == ErrorSource::tool_geometry;
    case LargeError::principal_point:
      return found == ErrorSource::principal_point;
    case LargeError::focal_length:
      return found == ErrorSource::focal_length;
    case LargeError::time_offset:
      return found == ErrorSource::time_offset;
    case LargeError::head_drift:
      return found == ErrorSource::head_drift;
    case LargeError::range_scale:
      break;  // no case of this list
  }
  return false;
}

}  // namespace

CaseList run_warnings(const CaseOptions& options) {
  CaseList list{"warnings", {}, {}};
  int done = 0, all = 0;
  for (const WarningCase& one : k_warning_cases) all += options.quick ? one.quick_seeds : one.seeds;
  for (const WarningCase& one : k_warning_cases) {
    const int seeds = options.quick ? one.quick_seeds : one.seeds;
    int named = 0, others = 0;
    double sigmas = 0;  // of the case's source, the largest
    for (int i = 0; i < seeds; ++i) {
      const auto findings = options.piece([&] {
        return findings_of(one, options.seed + static_cast<std::uint64_t>(i),
                           options.quick ? k_warned_quick_s : k_warned_s, options.out);
      });
      bool this_named = false, other_named = false;
      for (const CalibrationFinding& finding : findings) {
        const bool right = matches(finding.source, one.large);
        if (right) sigmas = std::max(sigmas, finding.size_in_stated_sigmas);
        this_named = this_named || (right && finding.exceeds_stated);
        other_named = other_named || (!right && finding.exceeds_stated);
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
