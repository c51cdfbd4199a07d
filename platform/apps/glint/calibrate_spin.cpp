// glint calibrate spin: axis of a tool that is rotated about it.
#include <memory>

#include "platform/apps/glint/calibrate_commands.hpp"
#include "platform/cells/tool_writer.hpp"
#include "platform/in_range.hpp"
#include "platform/tools/calibrate/figure_text.hpp"
#include "platform/tools/calibrate/spin.hpp"

namespace glint {
namespace {

struct SpinArguments {
  PoseSource source;
  CalibrationOutput output;
  double sigma_deg = 0;
};

// Direction from the tip to the markers, as the z axis of the built-in pen.
Vector3 upwards(const Tool& tool) {
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < tool.marker_count; ++i) sum += tool.markers_m[static_cast<std::size_t>(i)];
  return sum / tool.marker_count - tool.tip_m;
}

// Rotates the markers about the tip so that the tool's z is along the axis.
Tool turned_to_axis(Tool tool, const Vector3& axis) {
  const Quaternion turn = rotation_between(axis, Vector3::UnitZ());
  for (int i = 0; i < tool.marker_count; ++i) {
    Vector3& marker = tool.markers_m[static_cast<std::size_t>(i)];
    marker = turn * (marker - tool.tip_m) + tool.tip_m;
  }
  return tool;
}

Figures figures_for(const PoseSeries& series, const SpinResult& result) {
  return {{"source", series.what},
          {"axis", figures_of(result.axis, 1)},
          {"axis_sigma_deg", result.axis_sigma_rad * k_degrees_per_radian},
          {"axis_covariance_deg2",
           figures_of(result.axis_covariance_rad2, k_degrees_per_radian * k_degrees_per_radian)},
          {"foot_mm", figures_of(result.foot_m, 1e3)},
          {"foot_rms_mm", 1e3 * result.foot_rms_m},
          {"wobble_rms_deg", result.rms_rad * k_degrees_per_radian},
          {"turn_rms_deg", result.spread.spread_rad[1] * k_degrees_per_radian},
          {"poses", series.poses.size()},
          {"poses_used", result.poses_used},
          {"outliers", result.outliers},
          {"frames_without_pose", series.unsolved},
          {"poses_that_tell_as_one", result.variance_inflation},
          {"sigma_reached", result.sigma_reached}};
}

int run_spin(const SpinArguments& arguments) {
  const PoseSeries series = load_pose_series(arguments.source);
  SpinSettings settings;
  settings.stop_sigma_rad = arguments.sigma_deg / k_degrees_per_radian;
  if (series.tool) settings.axis_side_m = upwards(*series.tool);
  const SpinResult result = calibrate_spin(series.poses, settings, series.what);

  const Figures figures = figures_for(series, result);
  std::vector<double> wobble_deg;
  for (const double wobble : result.wobble_rad) wobble_deg.push_back(wobble * k_degrees_per_radian);
  std::vector<CalibrationFile> files{
      {"spin.toml", figures_toml(figures, "glint calibrate spin")},
      {"spin.svg",
       residual_plot({"Spin: angle error of the axis", "angle [deg]", wobble_deg, &result.kept})}};
  if (series.tool) {
    const std::string from = "z along the axis by glint calibrate spin from " + series.what +
                             ", sigma " + format_degrees(result.axis_sigma_rad);
    files.push_back({file_name_of(*series.tool) + ".toml",
                     tool_toml_text(turned_to_axis(*series.tool, result.axis), from)});
  }
  finish_calibration(arguments.output, figures, files);
  return result.sigma_reached ? 0 : 1;
}

}  // namespace

void add_calibrate_spin(CLI::App& calibrate, int& exit_code) {
  CLI::App* command =
      calibrate.add_subcommand("spin", "Calibrate the axis: the tool rolls about it, to and fro");
  auto arguments = std::make_shared<SpinArguments>();
  command->footer(
      "Example: glint calibrate spin --poses spin.tum --sigma-deg 0.05 --json spin.json\n"
      "With --tool the folder also holds NAME.toml, the tool rotated about its tip: z is the "
      "axis,\n"
      "from the tip to the markers. Exit code 1: --sigma-deg is not reached.");
  add_pose_options(*command, arguments->source);
  command
      ->add_option("--sigma-deg", arguments->sigma_deg,
                   "standard deviation of the axis at which to stop; 0: use every pose")
      ->check(in_range(0.0, 90.0));
  add_output_options(*command, arguments->output);
  command->callback([arguments, &exit_code] { exit_code = run_spin(*arguments); });
}

}  // namespace glint
