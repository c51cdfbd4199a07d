// glint calibrate noise: white and correlated noise of a static tool's poses, by Allan deviation.
#include <cmath>
#include <memory>
#include <optional>

#include "platform/apps/glint/calibrate_commands.hpp"
#include "platform/apps/glint/cell_option.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/calibrate/noise.hpp"
#include "platform/tools/inspect/recorded_frames.hpp"
#include "platform/tools/report/plots.hpp"

namespace glint {
namespace {

constexpr Duration k_apart_max = milliseconds(20);  // of two poses that are treated as simultaneous
constexpr const char* k_axis_names[k_pose_axes] = {"x", "y", "z", "rx", "ry", "rz"};

struct NoiseArguments {
  std::string poses, relative_to, recording, config, tool;
  CalibrationOutput output;
};

struct RestSeries {
  std::vector<TimedPose> poses;
  std::string what;
  std::optional<Cell> cell;  // of recorded frames; `tool` is its index there
  std::size_t tool = 0;
  std::vector<std::string> failures;
};

// Requires a static camera and a static tool.
RestSeries recorded_series(const NoiseArguments& arguments) {
  RecordedFrames recorded = open_recorded(arguments.recording, arguments.config);
  RestSeries series;
  series.tool = select_tool(recorded.cell, arguments.tool);
  PoseSeries found = recorded_poses(recorded, series.tool, PoseFrame::camera);
  series.poses = std::move(found.poses);
  series.what = std::move(found.what);
  series.failures = std::move(found.failures);
  series.cell = std::move(recorded.cell);
  return series;
}

std::vector<TimedPose> poses_in(const std::string& path, Time& begin) {
  PoseSource source;
  source.poses = path;
  PoseSeries series = load_pose_series(source);
  begin = series.begin;
  return std::move(series.poses);
}

RestSeries trajectory_series(const NoiseArguments& arguments) {
  RestSeries series;
  Time begin, other_begin;
  series.poses = poses_in(arguments.poses, begin);
  series.what = arguments.poses;
  if (arguments.relative_to.empty()) return series;
  std::vector<TimedPose> other = poses_in(arguments.relative_to, other_begin);
  for (TimedPose& pose : other) pose.time = pose.time + (other_begin - begin);
  series.poses = relative_poses(series.poses, other, k_apart_max);
  series.what += " relative to " + arguments.relative_to;
  return series;
}

double unit_of(std::size_t axis) { return axis < 3 ? 1e3 : k_degrees_per_radian; }

Figures three_of(const NoiseCalibration& found, std::size_t from, double AxisNoise::*part) {
  Figures values = Figures::array();
  for (std::size_t k = from; k < from + 3; ++k) values.push_back(unit_of(k) * found.axes[k].*part);
  return values;
}

Figures figures_for(const RestSeries& series, const NoiseCalibration& found) {
  Figures figures = {{"source", series.what},
                     {"poses", found.poses},
                     {"duration_s", found.duration_s},
                     {"period_ms", 1e3 * found.period_s},
                     {"worst_factor", found.worst_factor},
                     {"noise",
                      {{"white_mm", three_of(found, 0, &AxisNoise::white)},
                       {"fast_mm", three_of(found, 0, &AxisNoise::fast)},
                       {"slow_mm", three_of(found, 0, &AxisNoise::slow)},
                       {"white_deg", three_of(found, 3, &AxisNoise::white)},
                       {"fast_deg", three_of(found, 3, &AxisNoise::fast)},
                       {"slow_deg", three_of(found, 3, &AxisNoise::slow)},
                       {"fast_s", found.correlation.fast_s},
                       {"slow_s", found.correlation.slow_s}}}};
  if (series.cell) {
    const Tool& tool = series.cell->tools.items[series.tool];
    const CameraUncertainty errors =
        marker_errors_of(found, *series.cell, tool, series.poses[series.poses.size() / 2].pose);
    figures["uncertainty"] = {{"slow_range_mm", 1e3 * errors.correlated_range_m},
                              {"slow_centroid_px", errors.correlated_centroid_px},
                              {"fast_share", errors.fast_share},
                              {"fast_s", found.correlation.fast_s},
                              {"slow_s", found.correlation.slow_s}};
  }
  return figures;
}

std::string allan_plot(const NoiseCalibration& found, std::size_t from, const std::string& title,
                       const std::string& unit) {
  std::vector<LineSeries> lines;
  for (std::size_t k = from; k < from + 3; ++k) {
    LineSeries measured{std::string(k_axis_names[k]), {}},
        model{std::string(k_axis_names[k]) + " model", {}};
    for (const AllanPoint& point : found.allan) {
      const double at = std::log10(point.seconds);
      measured.points.push_back({at, std::log10(unit_of(k) * point.measured[k])});
      model.points.push_back({at, std::log10(unit_of(k) * point.model[k])});
    }
    lines.push_back(std::move(measured));
    lines.push_back(std::move(model));
  }
  return line_plot({title, "log10 of averaging time [s]", "log10 of deviation [" + unit + "]"},
                   lines);
}

int run_noise(const NoiseArguments& arguments) {
  if (arguments.poses.empty() == arguments.recording.empty()) {
    throw InputError("calibrate noise: expected either --poses FILE or --recording SOURCE");
  }
  if (!arguments.relative_to.empty() && arguments.poses.empty()) {
    throw InputError("calibrate noise: --relative-to without --poses; expected both");
  }
  const RestSeries series =
      arguments.recording.empty() ? trajectory_series(arguments) : recorded_series(arguments);
  const NoiseCalibration found = calibrate_noise(series.poses, series.what);
  const Figures figures = figures_for(series, found);
  const std::string use =
      series.cell ? "glint calibrate noise: for [camera] uncertainty = \"noise.toml\" of a cell"
                  : "glint calibrate noise";
  finish_calibration(
      arguments.output, figures,
      {{"noise.toml", figures_toml(figures, use)},
       {"noise_position.svg", allan_plot(found, 0, "Allan deviation of position", "mm")},
       {"noise_rotation.svg", allan_plot(found, 3, "Allan deviation of rotation", "deg")}});
  return report_losses(series.failures);
}

}  // namespace

void add_calibrate_noise(CLI::App& calibrate, int& exit_code) {
  CLI::App* command = calibrate.add_subcommand(
      "noise",
      "Estimate white and correlated noise from the Allan deviation: tool and camera rest");
  auto arguments = std::make_shared<NoiseArguments>();
  command->footer(
      "Examples:\n"
      "  glint calibrate noise --recording out/rest.mcap --tool pen --out out\n"
      "  glint calibrate noise --poses tool_a.tum --relative-to tool_b.tum --json noise.json\n"
      "Record two minutes or more. From frames, noise.toml also holds each marker's errors;\n"
      "entry in a cell: [camera] uncertainty = \"noise.toml\".");
  command->add_option("--poses", arguments->poses, "poses of a tool at rest: TUM text or CSV");
  command->add_option("--relative-to", arguments->relative_to,
                      "poses of a body beside the tool, from the same tracker: its drift cancels");
  add_recording_options(*command, arguments->recording, arguments->config);
  command->add_option("--tool", arguments->tool, "tool of the recording; default: the first");
  add_output_options(*command, arguments->output);
  command->callback([arguments, &exit_code] { exit_code = run_noise(*arguments); });
}

}  // namespace glint
