// glint calibrate headset: drift of the headset's own localisation.
#include <memory>

#include "kernels/angles.hpp"
#include "platform/apps/glint/calibrate_commands.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/calibrate/headset.hpp"

namespace glint {
namespace {

struct HeadsetArguments {
  std::string recording, config, tool;
  CalibrationOutput output;
};

Figures figures_for(const RecordedFrames& recorded, const HeadsetCalibration& found) {
  const HeadNoise& noise = found.noise;
  return {{"source", recorded.path},
          {"frames", found.frames},
          {"drift_factor", found.best_factor},
          {"drift_factor_sigma", found.sigma * found.best_factor},
          {"head_late_ms", 1e3 * found.head_delay_s},
          {"head_late_sigma_ms", 1e3 * found.head_late_sigma_s},
          {"headset",
           {{"rest_mm", 1e3 * noise.rest_position_m},
            {"rest_deg", k_degrees_per_radian * noise.rest_angle_rad},
            {"mm_per_m_s", 1e3 * noise.position_per_speed_s},
            {"mm_per_rad_s", 1e3 * noise.position_per_turn_m},
            {"mrad_per_m_s", 1e3 * noise.angle_per_speed_s_m},
            {"mrad_per_rad_s", 1e3 * noise.angle_per_turn_s}}}};
}

int run_headset(const HeadsetArguments& arguments) {
  if (arguments.recording.empty())
    throw InputError("calibrate headset: no --recording; expected recorded frames");
  RecordedFrames recorded = open_recorded(arguments.recording, arguments.config);
  const std::size_t tool = select_tool(recorded.cell, arguments.tool);
  const HeadsetCalibration found = calibrate_headset(recorded, tool);
  const Figures figures = figures_for(recorded, found);
  finish_calibration(
      arguments.output, figures,
      {{"headset.toml",
        figures_toml(figures, "glint calibrate headset: copy its [headset] to a cell")}});
  return report_losses(found.failures);
}

}  // namespace

void add_calibrate_headset(CLI::App& calibrate, int& exit_code) {
  CLI::App* command = calibrate.add_subcommand(
      "headset", "Estimate the drift of the headset's localisation: a tool rests, the head moves");
  auto arguments = std::make_shared<HeadsetArguments>();
  command->footer(
      "Example:\n"
      "  glint calibrate headset --recording out/look.mcap --tool pen --out out\n"
      "A minute or more: the tool rests in view, the head moves as at work. Copy [headset] of\n"
      "headset.toml to a cell; head_late_ms is for information only.");
  add_recording_options(*command, arguments->recording, arguments->config);
  command->add_option("--tool", arguments->tool, "tool that rests; default: the recording's first");
  add_output_options(*command, arguments->output);
  command->callback([arguments, &exit_code] { exit_code = run_headset(*arguments); });
}

}  // namespace glint
