// glint calibrate bias: mean error of a static tool, as a correction for a cell.
#include <memory>

#include "platform/apps/glint/calibrate_commands.hpp"
#include "platform/tools/calibrate/alignment_file.hpp"
#include "platform/tools/calibrate/bias.hpp"
#include "platform/tools/calibrate/figure_text.hpp"

namespace glint {
namespace {

struct BiasArguments {
  PoseSource source;
  std::string reference, align, along = "tool";
  CalibrationOutput output;
};

Figures range_figures(const ValidRange& range, double scale) {
  return {scale * range.from, scale * range.to};
}

Figures figures_for(const BiasArguments& arguments, const PoseSeries& series,
                    const BiasResult& result) {
  const BiasCorrection& correction = result.correction;
  return {{"source", series.what},
          {"reference", arguments.reference},
          {"mean_error_mm", 1e3 * correction.translation_m.norm()},
          {"mean_error_deg", correction.rotation_rad.norm() * k_degrees_per_radian},
          {"shift_sigma_mm", figures_of(result.translation_sigma_m, 1e3)},
          {"turn_sigma_deg", figures_of(result.rotation_sigma_rad, k_degrees_per_radian)},
          {"rms_before_mm", 1e3 * result.rms_before_m},
          {"rms_after_mm", 1e3 * result.rms_after_m},
          {"rms_before_deg", result.rms_before_rad * k_degrees_per_radian},
          {"rms_after_deg", result.rms_after_rad * k_degrees_per_radian},
          {"samples", result.samples},
          {"outliers", result.outliers},
          {"in_motion", result.moving},
          {"samples_that_tell_as_one", result.variance_inflation},
          {"correction",
           {{"frame", arguments.along},
            {"shift_mm", figures_of(correction.translation_m, 1e3)},
            {"turn_deg", figures_of(correction.rotation_rad, k_degrees_per_radian)},
            {"range_mm", range_figures(correction.range_m, 1e3)},
            {"off_axis_deg", range_figures(result.off_axis_rad, k_degrees_per_radian)},
            {"tilt_deg", range_figures(result.tilt_rad, k_degrees_per_radian)}}}};
}

int run_bias(const BiasArguments& arguments) {
  const PoseSeries series = load_pose_series(arguments.source);
  PoseSource reference_source;
  reference_source.poses = arguments.reference;
  PoseSeries reference = load_pose_series(reference_source);
  const Duration apart = reference.begin - series.begin;
  for (TimedPose& pose : reference.poses) pose.time = pose.time + apart;
  if (!arguments.align.empty()) {
    reference.poses = in_poses_frame(std::move(reference.poses), load_alignment(arguments.align));
  }
  BiasSettings settings;
  if (arguments.along == "camera") settings.frame = CorrectionFrame::camera;
  const BiasResult result = calibrate_bias(series.poses, reference.poses, settings, series.what);

  const Figures figures = figures_for(arguments, series, result);
  std::vector<double> distances_mm;
  for (const double distance : result.distances_m) distances_mm.push_back(1e3 * distance);
  finish_calibration(
      arguments.output, figures,
      {{"bias.toml",
        figures_toml(figures, "glint calibrate bias: for [correction] file of a cell")},
       {"bias.svg", residual_plot({"Bias: distance from the reference, corrected", "distance [mm]",
                                   distances_mm, &result.kept})}});
  return 0;
}

}  // namespace

void add_calibrate_bias(CLI::App& calibrate, int& exit_code) {
  CLI::App* command = calibrate.add_subcommand(
      "bias", "Estimate the mean error at rest against a reference, as a correction");
  auto arguments = std::make_shared<BiasArguments>();
  command->footer(
      "Example: glint calibrate bias --poses still.tum --reference tracker.tum \\\n"
      "           --align align.toml --json bias.json\n"
      "Poses are of the tool in the camera's frame. Hold camera and tool still, a second or more\n"
      "at each place; the correction holds for the recorded distances and angles. Take align.toml\n"
      "of `glint calibrate align` from another recording: its own one has no mean error left.\n"
      "Entry in a cell, which then subtracts the error: [correction] file = \"bias.toml\".");
  add_pose_options(*command, arguments->source);
  command
      ->add_option("--reference", arguments->reference,
                   "poses of the same tool from the reference: TUM text or EuRoC-like CSV")
      ->required();
  command->add_option("--align", arguments->align,
                      "align.toml: transforms and time offset; default: identity");
  command->add_option("--along", arguments->along, "axes along which the error is constant")
      ->check(CLI::IsMember({"tool", "camera"}))
      ->capture_default_str();
  add_output_options(*command, arguments->output);
  command->callback([arguments, &exit_code] { exit_code = run_bias(*arguments); });
}

}  // namespace glint
