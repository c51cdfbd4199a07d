// glint calibrate depth: bias of a camera's ranges to the markers in use (too long: positive).
#include <cmath>
#include <memory>

#include "platform/apps/glint/calibrate_commands.hpp"
#include "platform/apps/glint/cell_option.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/cells/toml_reader.hpp"
#include "platform/cells/tool_file.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/calibrate/depth.hpp"
#include "platform/tools/calibrate/figure_text.hpp"

namespace glint {
namespace {

struct DepthArguments {
  std::string recording, samples, tool, config;
  bool no_brightness = false;
  CalibrationOutput output;
};

Figures figures_for(const BlobSeries& series, const Tool& tool, const ObservationSeries& seen,
                    const DepthCalibration& found) {
  const auto sigma_mm = [&](int i) { return 1e3 * std::sqrt(found.covariance(i, i)); };
  return {{"source", series.what},
          {"tool", tool.name.data()},
          {"marker_radius_mm", 1e3 * tool.marker_radius_m},
          {"offset_sigma_mm", sigma_mm(0)},
          {"mm_per_m_sigma", sigma_mm(1)},
          {"dim_sigma_mm", sigma_mm(2)},
          {"rms_before_mm", 1e3 * found.rms_before_m},
          {"rms_after_mm", 1e3 * found.rms_after_m},
          {"pixel_sigma_px", found.pixel_sigma_px},
          {"range_sigma_mm", 1e3 * found.range_sigma_m},
          {"peaks", {found.peak_from, found.peak_to}},
          {"range_dim_correlation", found.range_dim_correlation},
          {"frames", seen.frames},
          {"frames_used", found.frames},
          {"frames_ambiguous", seen.ambiguous},
          {"markers", found.markers},
          {"outliers", found.outliers},
          {"frames_that_tell_as_one", found.variance_inflation},
          {"depth_bias",
           {{"offset_mm", 1e3 * found.bias.offset_m},
            {"mm_per_m", 1e3 * found.bias.per_metre},
            {"dim_mm", 1e3 * found.bias.low_signal_m},
            {"range_mm", {1e3 * found.bias.range_min_m, 1e3 * found.bias.range_max_m}}}}};
}

BlobSeries tabled_blobs(const DepthArguments& arguments) {
  const std::string& path = arguments.samples;
  BlobSeries series =
      blobs_from_text(read_text(path), path, cell_or_default(arguments.config).camera);
  if (arguments.tool.empty()) {
    throw InputError(path + ": a table of blobs names no tool; expected --tool");
  }
  series.tool = named_tool(arguments.tool);
  return series;
}

int run_depth(const DepthArguments& arguments) {
  if (arguments.recording.empty() == arguments.samples.empty()) {
    throw InputError("calibrate depth: expected either --recording FILE or --blobs FILE");
  }
  const BlobSeries series =
      arguments.recording.empty()
          ? tabled_blobs(arguments)
          : recorded_blobs(arguments.recording, arguments.config, arguments.tool);
  const Tool& tool = *series.tool;
  DepthCalibrationSettings settings;
  if (arguments.no_brightness) settings.brightness = Brightness::left_out;
  if (!series.brightness && !arguments.no_brightness) {
    throw InputError(series.what +
                     ": recorded at level blobs, without brightness: dim_mm is not observable; "
                     "expected level roi or full, or --no-brightness");
  }
  const ObservationSeries seen = find_tool(series, tool, {});
  const DepthCalibration found = calibrate_depth(seen.observations, tool, settings, series.what);

  const Figures figures = figures_for(series, tool, seen, found);
  std::vector<double> misses_mm;
  for (const double miss : found.residuals_m) misses_mm.push_back(1e3 * miss);
  finish_calibration(
      arguments.output, figures,
      {{"depth.toml",
        figures_toml(figures,
                     "glint calibrate depth: for [camera] depth_bias = \"depth.toml\"\n"
                     "of a cell, for markers of this kind only")},
       {"depth.svg", residual_plot({"Depth: residual of each marker's range after the bias",
                                    "distance [mm]", misses_mm, &found.kept})}});
  return report_losses(series.failures);
}

}  // namespace

void add_calibrate_depth(CLI::App& calibrate, int& exit_code) {
  CLI::App* command = calibrate.add_subcommand(
      "depth", "Calibrate the range bias: a tool of known size, near and far, bright and dim");
  auto arguments = std::make_shared<DepthArguments>();
  command->footer(
      "Examples:\n"
      "  glint calibrate depth --recording out/run.mcap --tool pen --json depth.json\n"
      "  glint calibrate depth --recording frames --tool probe.toml --config cell.toml\n"
      "  glint calibrate depth --blobs blobs.csv --tool probe.toml --config cell.toml\n"
      "blobs.csv: time_s,x_px,y_px,range_m,peak, one unlabelled blob a row; pixel centres at +\n"
      "0.5, ranges along the ray to the marker's surface. Move the tool through all ranges of its\n"
      "use and tilt it to and fro. A recording of level blobs needs --no-brightness.\n"
      "Entry in a cell: [camera] depth_bias = \"depth.toml\".");
  add_recording_options(*command, arguments->recording, arguments->config);
  command->add_option("--blobs", arguments->samples,
                      "table of blobs (CSV), instead of --recording");
  command->add_option("--tool", arguments->tool,
                      "tool: file (.toml, .rom, .ini), name of a recorded tool, or pen (built in)");
  command->add_flag("--no-brightness", arguments->no_brightness,
                    "bias by range only: dim_mm stays 0");
  add_output_options(*command, arguments->output);
  command->callback([arguments, &exit_code] { exit_code = run_depth(*arguments); });
}

}  // namespace glint
