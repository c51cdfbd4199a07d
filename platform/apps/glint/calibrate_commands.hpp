// Subcommands of `glint calibrate`, with their common options and output.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "platform/tools/calibrate/calibration_report.hpp"
#include "platform/tools/calibrate/pose_series.hpp"

namespace glint {

void add_calibrate_pivot(CLI::App& calibrate, int& exit_code);
void add_calibrate_spin(CLI::App& calibrate, int& exit_code);
void add_calibrate_tool(CLI::App& calibrate, int& exit_code);
void add_calibrate_align(CLI::App& calibrate, int& exit_code);
void add_calibrate_bias(CLI::App& calibrate, int& exit_code);
void add_calibrate_depth(CLI::App& calibrate, int& exit_code);
void add_calibrate_motion(CLI::App& calibrate, int& exit_code);
void add_calibrate_camera(CLI::App& calibrate, int& exit_code);
void add_calibrate_headset(CLI::App& calibrate, int& exit_code);
void add_calibrate_noise(CLI::App& calibrate, int& exit_code);

struct CalibrationOutput {
  std::string out = "out";
  std::string json;
};

void add_output_options(CLI::App& command, CalibrationOutput& output);
void add_pose_options(CLI::App& command, PoseSource& source);
// --recording SOURCE, and the cell of its camera.
void add_recording_options(CLI::App& command, std::string& recording, std::string& cell_file);

struct CalibrationFile {
  std::string name;
  std::string text;
};
// Prints the table, then writes the files into the folder and the figures as JSON.
void finish_calibration(const CalibrationOutput& output, const Figures& figures,
                        const std::vector<CalibrationFile>& files);

}  // namespace glint
