#include <string>
#include <vector>

#include "kernels/angles.hpp"
#include "platform/lab/experiments/recordings.hpp"
#include "platform/lab/experiments/strokes_run.hpp"

namespace glint {
namespace {

constexpr int k_stroke_seeds = 20, k_stroke_seeds_quick = 1;
constexpr double k_stroke_inside_min = 90, k_stroke_inside_max = 98, k_sharpness_max = 1.5;
constexpr double k_rate_ratio_max = 1.5, k_from_line_max_mm = 1.0;

double percentage(std::int64_t part, std::int64_t whole) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

ExperimentCase stroke_case(const std::string& name, const char* method, const StrokeErrors& errors,
                           bool judged) {
  const auto bar = [&](Bar limit) { return judged ? limit : Bar::none(); };
  const double position = percentage(errors.position_inside, errors.n);
  const double rotation = percentage(errors.rotation_inside, errors.n);
  return {name,
          method,
          errors.n,
          {{"position_rms", "mm", 1e3 * errors.position_rms_m()},
           {"rotation_rms", "deg", errors.rotation_rms_rad() / k_radians_per_degree},
           {"inside", "%", position, bar(Bar::at_least(k_stroke_inside_min))},
           {"inside_most", "%", position, bar(Bar::at_most(k_stroke_inside_max))},
           {"rotation_inside", "%", rotation, bar(Bar::at_least(k_stroke_inside_min))},
           {"rotation_inside_most", "%", rotation, bar(Bar::at_most(k_stroke_inside_max))},
           {"sigma_over_rms", "", errors.position_sigma_m() / errors.position_rms_m(),
            bar(Bar::at_most(k_sharpness_max))},
           {"rotation_sigma_over_rms", "", errors.rotation_sigma_rad() / errors.rotation_rms_rad(),
            bar(Bar::at_most(k_sharpness_max))}}};
}

std::string stroke_name(const StrokeCase& stroke) {
  const char* shape = stroke.shape == StrokeShape::hand   ? "hand"
                      : stroke.shape == StrokeShape::edge ? "edge 300 mm"
                                                          : "circle 100 mm";
  return std::string(shape) + (stroke.slow ? ", 5 Hz" : ", 45 Hz") +
         (stroke.reference_body ? ", body" : "");
}

// Motions that the simulator did not make: without bars, as their ends and gaps are not a hand's.
void add_recorded(const CaseOptions& options, CaseList& list) {
  const std::vector<Trajectory> motions = load_recordings(options);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    for (const bool slow : {false, true}) {
      const StrokeErrors errors = options.piece([&] {
        return follow_recorded_stroke(motions[i], slow ? milliseconds(200) : Duration{22'222'222},
                                      options.seed);
      });
      list.cases.push_back(
          stroke_case(std::string(k_recordings[i].name) + (slow ? ", 5 Hz" : ", 45 Hz"), "smoothed",
                      errors, false));
    }
  }
}

}  // namespace

CaseList run_strokes(const CaseOptions& options) {
  using enum StrokeShape;
  constexpr StrokeCase k_stroke_cases[] = {
      {hand, false, true}, {hand, true, true}, {hand, false, false},  {hand, true, false},
      {edge, false, true}, {edge, true, true}, {circle, false, true}, {circle, true, true}};
  CaseList list{"strokes", {}, {}};
  const int seeds = options.quick ? k_stroke_seeds_quick : k_stroke_seeds;
  const int all = static_cast<int>(std::size(k_stroke_cases)) * seeds;
  int done = 0;
  double fast_rms_m = 0;
  StrokeErrors pooled;  // both rates
  for (const StrokeCase& stroke : k_stroke_cases) {
    StrokeTally tally;
    for (int i = 0; i < seeds; ++i) {
      tally.add(options.piece(
          [&] { return follow_stroke(stroke, options.seed + static_cast<std::uint64_t>(i)); }));
      if (options.progress) options.progress(++done, all);
    }
    const bool judged = !options.quick;
    const auto bar = [&](Bar limit) { return judged ? limit : Bar::none(); };
    ExperimentCase smoothed = stroke_case(stroke_name(stroke), "smoothed", tally.smoothed, judged);
    ExperimentCase live = stroke_case(stroke_name(stroke), "live", tally.live, false);
    if (stroke.shape == hand) {
      if (stroke.slow)
        smoothed.figures.push_back({"over_45_hz", "", tally.smoothed.position_rms_m() / fast_rms_m,
                                    bar(Bar::at_most(k_rate_ratio_max))});
      fast_rms_m = tally.smoothed.position_rms_m();
      if (!stroke.slow) pooled = {};
      pooled.add(tally.smoothed);
    } else {
      smoothed.figures.push_back({"from_line", "mm", 1e3 * tally.smoothed.from_line_rms_m(),
                                  bar(Bar::at_most(k_from_line_max_mm))});
      live.figures.push_back({"from_line", "mm", 1e3 * tally.live.from_line_rms_m()});
    }
    smoothed.figures.push_back({"ticks_with_pose", "%", percentage(tally.smoothed.n, tally.ticks)});
    list.cases.push_back(std::move(smoothed));
    list.cases.push_back(std::move(live));
    if (stroke.shape == hand && stroke.slow) {
      list.cases.push_back(
          stroke_case(stroke.reference_body ? "hand, pooled, body" : "hand, pooled", "smoothed",
                      pooled, judged));
    }
  }
  if (!options.data.empty()) add_recorded(options, list);
  return list;
}

}  // namespace glint
