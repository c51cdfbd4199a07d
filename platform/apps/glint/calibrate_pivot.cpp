// glint calibrate pivot: tip of a tool by pivot calibration (rotation about a fixed point).
#include <algorithm>
#include <cmath>
#include <memory>

#include "platform/apps/glint/calibrate_commands.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/cells/tool_writer.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/calibrate/figure_text.hpp"
#include "platform/tools/calibrate/pivot.hpp"

namespace glint {
namespace {

struct PivotArguments {
  PoseSource source;
  CalibrationOutput output;
  std::string frame = "by_head";
  double sigma_mm = 0;
};

Figures figures_for(const PoseSeries& series, const PivotResult& result) {
  return {{"source", series.what},
          {"frame", series.frame},
          {"tip_mm", figures_of(result.tip_m, 1e3)},
          {"tip_sigma_mm", 1e3 * result.tip_sigma_m},
          {"tip_covariance_mm2", figures_of(result.tip_covariance_m2, 1e6)},
          {"post_mm", figures_of(result.post_m, 1e3)},
          {"rms_mm", 1e3 * result.rms_m},
          {"position_noise_mm", 1e3 * result.position_sigma_m},
          {"rotation_noise_deg", result.rotation_sigma_rad * k_degrees_per_radian},
          {"least_spread_deg", result.spread.spread_rad[0] * k_degrees_per_radian},
          {"poses", series.poses.size()},
          {"poses_used", result.poses_used},
          {"outliers", result.outliers},
          {"frames_without_pose", series.unsolved},
          {"poses_that_tell_as_one", result.variance_inflation},
          {"sigma_reached", result.sigma_reached}};
}

PoseFrame frame_of(const std::string& name) {
  if (name == "camera") return PoseFrame::camera;
  return name == "world" ? PoseFrame::world : PoseFrame::by_head;
}

int run_pivot(const PivotArguments& arguments) {
  PoseSource source = arguments.source;
  source.frame = frame_of(arguments.frame);
  if (source.poses.empty() && source.points.empty() && source.recording.empty()) {
    throw InputError(
        "calibrate pivot: expected one of --poses FILE, --points FILE and --recording SOURCE");
  }
  const PoseSeries series = load_pose_series(source);
  PivotSettings settings;
  settings.stop_sigma_m = 1e-3 * arguments.sigma_mm;
  if (series.tool) settings.centre_m = series.tool->middle_m();
  settings.scale_sigma = series.scale_sigma;
  const PivotResult result = calibrate_pivot(series.poses, settings, series.what);

  const Figures figures = figures_for(series, result);
  std::vector<double> distances_mm;
  for (const double distance : result.distances_m) distances_mm.push_back(1e3 * distance);
  std::vector<CalibrationFile> files{
      {"pivot.toml", figures_toml(figures, "glint calibrate pivot")},
      {"pivot.svg", residual_plot({"Pivot: distance of the tip from its post", "distance [mm]",
                                   distances_mm, &result.kept})}};
  if (series.tool) {
    Tool tool = *series.tool;
    tool.tip_m = result.tip_m;
    tool.tip_sigma_m = std::sqrt(result.tip_covariance_m2.trace() / 3);
    const std::string from = "tip by glint calibrate pivot from " + series.what + ", sigma " +
                             format_mm(result.tip_sigma_m);
    files.push_back({file_name_of(tool) + ".toml", tool_toml_text(tool, from)});
  }
  finish_calibration(arguments.output, figures, files);
  return std::max(report_losses(series.failures), result.sigma_reached ? 0 : 1);
}

}  // namespace

void add_calibrate_pivot(CLI::App& calibrate, int& exit_code) {
  CLI::App* command = calibrate.add_subcommand(
      "pivot", "Calibrate the tip: it stands in a dent, the tool tilts to all sides");
  auto arguments = std::make_shared<PivotArguments>();
  command->footer(
      "Examples:\n"
      "  glint calibrate pivot --poses out/tip.tum --of-tip --tool pen.toml --sigma-mm 0.1\n"
      "  glint calibrate pivot --points markers.csv --tool probe.toml --json pivot.json\n"
      "  glint calibrate pivot --recording frames --config cell.toml --tool probe.toml\n"
      "  glint calibrate pivot --recording frames --config cell.toml --frame camera --out out\n"
      "--recording: poses are in the world if most frames have a head pose, else in the camera's\n"
      "frame, which must not move (`frame` in the table). For a headset on a stand use --frame\n"
      "camera: its drift then has no effect.\n"
      "With --tool the folder also holds NAME.toml, the tool with its new tip, for a cell's "
      "tools.\n"
      "Exit code 1: --sigma-mm is not reached.");
  add_pose_options(*command, arguments->source);
  add_recording_options(*command, arguments->source.recording, arguments->source.cell_file);
  command->add_option("--frame", arguments->frame, "frame of the poses of --recording")
      ->check(CLI::IsMember({"by_head", "camera", "world"}))
      ->capture_default_str();
  command
      ->add_option("--sigma-mm", arguments->sigma_mm,
                   "standard deviation of the tip at which to stop; 0: use every pose")
      ->check(in_range(0.0, 1000.0));
  add_output_options(*command, arguments->output);
  command->callback([arguments, &exit_code] { exit_code = run_pivot(*arguments); });
}

}  // namespace glint
