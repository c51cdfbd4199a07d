#include "platform/lab/experiments/experiment_report.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "platform/tools/report/plots.hpp"

namespace glint {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t k_path_frames = 300;  // ten seconds

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json json_of(const PublishedFigures& figures) {
  return {{"position_mean_abs_mm", figures.position_mean_abs_mm},
          {"angle_mean_abs_deg", figures.angle_mean_abs_deg},
          {"position_sd_mm", or_null(figures.position_sd_mm)},
          {"angle_sd_deg", or_null(figures.angle_sd_deg)},
          {"position_median_mm", or_null(figures.position_median_mm)},
          {"angle_median_deg", or_null(figures.angle_median_deg)},
          {"frames_per_s", figures.frames_per_s},
          {"samples", figures.samples}};
}

Json spread_json(const ErrorColumn& column) {
  const Json fit =
      column.fit.valid ? Json{{"mean", column.fit.mean}, {"sd", column.fit.sd}} : Json(nullptr);
  return {{"norm_mean", column.norm_mean},
          {"norm_p95", column.norm_p95},
          {"mean", column.summary.mean},
          {"rms", column.summary.rms},
          {"gaussian_fit", fit},
          {"histogram",
           {{"low", column.histogram.low},
            {"bin_width", column.histogram.width},
            {"counts", column.histogram.counts},
            {"below", column.histogram.below},
            {"above", column.histogram.above}}}};
}

Json json_of(const MethodFigures& figures) {
  return {{"position_mean_abs_mm", figures.position_mm.summary.mean_abs},
          {"angle_mean_abs_deg", figures.angle_deg.summary.mean_abs},
          {"position_sd_mm", figures.position_mm.summary.sd},
          {"angle_sd_deg", figures.angle_deg.summary.sd},
          {"position_median_mm", figures.position_mm.summary.median},
          {"angle_median_deg", figures.angle_deg.summary.median},
          {"frames_per_s", figures.frames_per_s},
          {"covered", or_null(figures.covered)},
          {"samples", figures.samples},
          {"frames", figures.frames},
          {"position_mm", spread_json(figures.position_mm)},
          {"angle_deg", spread_json(figures.angle_deg)}};
}

// Figures of one row; nullopt for a column without one.
struct Row {
  std::optional<double> published, baseline, glint, held, perfect;
};

std::string row(const char* name, const Row& figures, int decimals) {
  char line[64];
  std::snprintf(line, sizeof line, "  %-34s", name);
  std::string text = line;
  for (const auto& figure :
       {figures.published, figures.baseline, figures.glint, figures.held, figures.perfect}) {
    if (figure) {
      std::snprintf(line, sizeof line, " %12.*f", decimals, *figure);
    } else {
      std::snprintf(line, sizeof line, " %12s", "-");
    }
    text += line;
  }
  return text + '\n';
}

HistogramSeries series_of(const std::string& name, const ErrorColumn& column) {
  return {name, column.histogram, column.fit};
}

// A longer path would fill the plot.
TrajectorySeries beginning_of(const std::string& name, const std::vector<Vector3>& path_m) {
  const auto length = static_cast<std::ptrdiff_t>(std::min(path_m.size(), k_path_frames));
  return {name, {path_m.begin(), path_m.begin() + length}};
}

}  // namespace

std::string name_of(ExperimentKind kind) {
  return kind == ExperimentKind::still ? "static" : "dynamic";
}

std::string experiment_json(const ExperimentResult& result) {
  Json json;
  json["experiment"] = name_of(result.kind);
  json["quick"] = result.quick;
  json["config_hash"] = result.config_hash;
  json["published"] = json_of(published_figures(result.kind));
  json["baseline"] = json_of(result.baseline);
  json["glint"] = json_of(result.glint);
  json["glint_held"] = json_of(result.glint_held);
  json["perfect_tracker"] = json_of(result.perfect);
  const ExperimentBars bars = bars_of(result.kind);
  json["bars"] = {{"position_mean_abs_mm", bars.position_mm},
                  {"angle_mean_abs_deg", bars.angle_deg},
                  {"missed", missed_bars(result)}};
  json["declared"] = Json::parse(result.declared);
  return json.dump(2) + '\n';
}

std::string experiment_table(const ExperimentResult& result) {
  const PublishedFigures published = published_figures(result.kind);
  const MethodFigures &baseline = result.baseline, &glint = result.glint, &held = result.glint_held,
                      &perfect = result.perfect;
  const auto fit_sd = [](const ErrorColumn& column) {
    return column.fit.valid ? column.fit.sd : 0;
  };
  std::string text = "Experiment " + name_of(result.kind) + (result.quick ? " (quick)" : "") +
                     ", parameters " + result.config_hash + '\n';
  char heading[128];
  std::snprintf(heading, sizeof heading, "  %-34s %12s %12s %12s %12s %12s\n", "", "published",
                "baseline", "Glint", "with body", "perfect");
  text += heading;
  const auto block = [&](const char* unit, ErrorColumn MethodFigures::*column, double mean_abs,
                         const std::optional<double>& sd, const std::optional<double>& median) {
    const ErrorColumn &s = baseline.*column, &g = glint.*column, &h = held.*column,
                      &p = perfect.*column;
    const std::string of = std::string(" [") + unit + "]";
    const std::string what = unit == std::string("mm") ? "position " : "angle ";
    text += row(
        (what + "mean absolute" + of).c_str(),
        {mean_abs, s.summary.mean_abs, g.summary.mean_abs, h.summary.mean_abs, p.summary.mean_abs},
        2);
    text += row((what + "standard deviation" + of).c_str(),
                {sd, s.summary.sd, g.summary.sd, h.summary.sd, p.summary.sd}, 2);
    text +=
        row((what + "median" + of).c_str(),
            {median, s.summary.median, g.summary.median, h.summary.median, p.summary.median}, 2);
    text += row((what + "Gaussian fit, sd" + of).c_str(),
                {std::nullopt, fit_sd(s), fit_sd(g), fit_sd(h), fit_sd(p)}, 2);
    text += row((what + "mean length" + of).c_str(),
                {std::nullopt, s.norm_mean, g.norm_mean, h.norm_mean, p.norm_mean}, 2);
  };
  block("mm", &MethodFigures::position_mm, published.position_mean_abs_mm, published.position_sd_mm,
        published.position_median_mm);
  block("deg", &MethodFigures::angle_deg, published.angle_mean_abs_deg, published.angle_sd_deg,
        published.angle_median_deg);
  text += row("inside the 95 % ellipsoid",
              {std::nullopt, baseline.covered, glint.covered, held.covered, perfect.covered}, 3);
  text += row("frames a second",
              {published.frames_per_s, baseline.frames_per_s, glint.frames_per_s, held.frames_per_s,
               std::nullopt},
              0);
  const auto count = [](int n) { return std::optional<double>(n); };
  text += row("samples",
              {published.samples, count(baseline.samples), count(glint.samples),
               count(held.samples), count(perfect.samples)},
              0);
  text += row("frames",
              {std::nullopt, count(baseline.frames), count(glint.frames), count(held.frames),
               count(perfect.frames)},
              0);
  const ExperimentBars bars = bars_of(result.kind);
  char bar[128];
  std::snprintf(bar, sizeof bar,
                "  bars with the reference body: %.1f mm, %.1f deg mean absolute: %s\n",
                bars.position_mm, bars.angle_deg, missed_bars(result) == 0 ? "met" : "MISSED");
  text += bar;
  text +=
      "  Errors of the tip in the headset's world against the reference tracker: x, y and z "
      "pooled;\n"
      "  the length of the whole error beside them. Frames a second: 1 / mean time of a frame on "
      "one\n"
      "  thread of this machine; published: of the whole application on a HoloLens 1. Perfect: "
      "the\n"
      "  true pose before the camera, in the headset's world: the effect of drift alone.\n";
  return text;
}

std::vector<std::string> write_experiment_plots(const ExperimentResult& result,
                                                const std::string& folder) {
  const std::string name = name_of(result.kind);
  std::vector<std::string> written;
  const auto write = [&](const std::string& part, const std::string& svg) {
    written.push_back(folder + '/' + name + '_' + part + ".svg");
    write_text_file(written.back(), svg);
  };
  write("position",
        histogram_plot({"Position error, " + name, "error along an axis [mm]", "part a mm"},
                       std::vector{series_of("baseline", result.baseline.position_mm),
                                   series_of("Glint", result.glint.position_mm)}));
  write("angle",
        histogram_plot({"Angle error, " + name, "error about an axis [deg]", "part a degree"},
                       std::vector{series_of("baseline", result.baseline.angle_deg),
                                   series_of("Glint", result.glint.angle_deg)}));
  write("path", trajectory_plot("Tip, " + name + ", ten seconds",
                                std::vector{beginning_of("reference", result.path.reference_m),
                                            beginning_of("baseline", result.path.baseline_m),
                                            beginning_of("Glint", result.path.glint_m)}));
  return written;
}

}  // namespace glint
