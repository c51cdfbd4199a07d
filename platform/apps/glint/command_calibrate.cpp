// glint calibrate: calibration of a user's tools and devices from measurements.
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "platform/apps/glint/calibrate_commands.hpp"
#include "platform/apps/glint/cell_option.hpp"
#include "platform/apps/glint/commands.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/printable.hpp"

namespace glint {

void add_output_options(CLI::App& command, CalibrationOutput& output) {
  command.add_option("--out", output.out, "folder of the TOML file and the plot")
      ->capture_default_str();
  command.add_option("--json", output.json, "file of the figures");
}

void add_pose_options(CLI::App& command, PoseSource& source) {
  command.add_option("--poses", source.poses,
                     "poses of the tool: TUM text, EuRoC-like CSV, or a run's .mcap");
  command.add_option("--points", source.points,
                     "marker positions instead: CSV time_s,x_m,y_m,z_m, unlabelled");
  command.add_option("--tool", source.tool, "tool: file (.toml, .rom, .ini) or pen (built in)");
  command.add_flag("--of-tip", source.of_tip, "poses of the tool's tip, as in a run's tip.tum");
}

void add_recording_options(CLI::App& command, std::string& recording, std::string& cell_file) {
  command.add_option("--recording", recording,
                     "recorded frames (any kind that `glint track` reads), instead");
  add_cell_option(command, cell_file,
                  "cell file of the camera; default: the recording's own, else the built-in cell");
}

void finish_calibration(const CalibrationOutput& output, const Figures& figures,
                        const std::vector<CalibrationFile>& files) {
  std::fputs(printable_lines(figures_table(figures)).c_str(), stdout);
  for (const CalibrationFile& file : files) {
    const std::string path = (std::filesystem::path(output.out) / file.name).string();
    write_text(path, file.text);
    std::printf("written  %s\n", path.c_str());
  }
  write_json(output.json, figures);
}

void add_calibrate(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "calibrate",
      "Calibrate a tool's tip, axis and markers, the lens, biases and the motion filter");
  command->require_subcommand(1);
  command->footer("Example: glint calibrate pivot --poses tip.tum --of-tip --tool pen.toml");
  add_calibrate_pivot(*command, exit_code);
  add_calibrate_spin(*command, exit_code);
  add_calibrate_tool(*command, exit_code);
  add_calibrate_align(*command, exit_code);
  add_calibrate_bias(*command, exit_code);
  add_calibrate_depth(*command, exit_code);
  add_calibrate_motion(*command, exit_code);
  add_calibrate_camera(*command, exit_code);
  add_calibrate_noise(*command, exit_code);
  add_calibrate_headset(*command, exit_code);
}

}  // namespace glint
