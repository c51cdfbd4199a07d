// glint calibrate align: transform between the frames of two trackers, and their clock offset.
#include <cmath>
#include <memory>

#include "platform/apps/glint/calibrate_commands.hpp"
#include "platform/cells/cell.hpp"
#include "platform/in_range.hpp"
#include "platform/tools/calibrate/align.hpp"
#include "platform/tools/calibrate/figure_text.hpp"

namespace glint {
namespace {

struct AlignArguments {
  PoseSource source;
  std::string reference;
  double offset_max_s = 0.5;
  bool no_lever = false, align_starts = false;
  CalibrationOutput output;
};

// Order x, y, z, w.
Figures quaternion_figures(const Quaternion& q) { return {q.x(), q.y(), q.z(), q.w()}; }

Figures pose_figures(const Pose& pose) {
  return {{"position_mm", figures_of(pose.translation, 1e3)},
          {"rotation_xyzw", quaternion_figures(pose.rotation)}};
}

// Pose of the reference in the frame of the poses. If the reference is a robot's base, this is the
// [robot] of a cell.
Figures robot_figures(const AlignResult& result) {
  const Pose T_file_reference = result.T_reference_file.inverse();
  return {{"position_mm", figures_of(T_file_reference.translation, 1e3)},
          {"rotation_deg", figures_of(fixed_axes_deg(T_file_reference.rotation), 1)}};
}

Figures figures_for(const AlignArguments& arguments, const PoseSeries& series,
                    const AlignResult& result, double offset_s) {
  return {{"source", series.what},
          {"reference", arguments.reference},
          {"offset_ms", 1e3 * offset_s},
          {"offset_sigma_ms", 1e3 * result.offset_sigma_s},
          {"position_sigma_mm", 1e3 * result.position_sigma_m},
          {"rotation_sigma_deg", result.rotation_sigma_rad * k_degrees_per_radian},
          {"lever_arm_sigma_mm", 1e3 * result.lever_sigma_m},
          {"rms_mm", 1e3 * result.rms_m},
          {"rms_deg", result.rms_rad * k_degrees_per_radian},
          {"least_spread_deg", result.spread.spread_rad[0] * k_degrees_per_radian},
          {"samples", result.samples},
          {"outliers", result.outliers},
          {"frames_without_pose", series.unsolved},
          {"T_reference_poses", pose_figures(result.T_reference_file)},
          {"T_tool_body", pose_figures(result.T_tool_body)},
          {"robot", robot_figures(result)}};
}

int run_align(const AlignArguments& arguments) {
  const PoseSeries series = load_pose_series(arguments.source);
  PoseSource reference_source;
  reference_source.poses = arguments.reference;
  PoseSeries reference = load_pose_series(reference_source);
  const Duration apart = reference.begin - series.begin;
  if (!arguments.align_starts) {
    for (TimedPose& pose : reference.poses) pose.time = pose.time + apart;
  }
  AlignSettings settings;
  settings.offset_max_s = arguments.offset_max_s;
  settings.lever_arm = arguments.no_lever ? LeverArm::none : LeverArm::unknown;
  const AlignResult result = align_series(series.poses, reference.poses, settings, series.what);

  const double offset_s = result.offset_s + (arguments.align_starts ? apart.seconds() : 0);
  const Figures figures = figures_for(arguments, series, result, offset_s);
  std::vector<double> distances_mm;
  for (const double distance : result.distances_m) distances_mm.push_back(1e3 * distance);
  finish_calibration(
      arguments.output, figures,
      {{"align.toml",
        figures_toml(
            figures,
            "glint calibrate align: [robot] of a cell, if the reference is the robot's base")},
       {"align.svg", residual_plot({"Align: distance from the reference", "distance [mm]",
                                    distances_mm, &result.kept})}});
  return 0;
}

}  // namespace

void add_calibrate_align(CLI::App& calibrate, int& exit_code) {
  CLI::App* command = calibrate.add_subcommand(
      "align",
      "Align a reference tracker: frame, lever arm and clock, from the same tool's motion");
  auto arguments = std::make_shared<AlignArguments>();
  command->footer(
      "Example: glint calibrate align --poses out/tip.tum --of-tip --tool pen.toml \\\n"
      "           --reference robot.tum --json align.json\n"
      "Move the tool to and fro and turn it about two axes. offset_ms: the reference's stamp\n"
      "minus the poses' stamp of the same instant.");
  add_pose_options(*command, arguments->source);
  command
      ->add_option("--reference", arguments->reference,
                   "poses of the same motion from the reference: TUM text or EuRoC-like CSV")
      ->required();
  command
      ->add_option("--max-offset-s", arguments->offset_max_s,
                   "largest offset of the clocks, either sign")
      ->check(in_range(0.0, 60.0))
      ->capture_default_str();
  command->add_flag("--align-starts", arguments->align_starts,
                    "unrelated clocks: align the starts of both series");
  command->add_flag("--no-lever", arguments->no_lever,
                    "both report the same frame of the tool: no lever arm is estimated");
  add_output_options(*command, arguments->output);
  command->callback([arguments, &exit_code] { exit_code = run_align(*arguments); });
}

}  // namespace glint
