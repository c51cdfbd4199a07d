// glint calibrate tool: marker geometry of a new tool, from its motion.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "platform/apps/glint/calibrate_commands.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/cells/tool_file.hpp"
#include "platform/cells/tool_formats.hpp"
#include "platform/cells/tool_writer.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/calibrate/figure_text.hpp"
#include "platform/tools/calibrate/tool_geometry.hpp"
#include "platform/tools/inspect/recorded_frames.hpp"

namespace glint {
namespace {

struct ToolArguments {
  std::string points, recording, config, like, name = "tool", shape = "sphere";
  double radius_mm = 5.75, longest_side_mm = 0, longest_sigma_mm = 0.1, noise_mm = 1.0;
  CalibrationOutput output;
};

const std::string& source_of(const ToolArguments& arguments) {
  return arguments.recording.empty() ? arguments.points : arguments.recording;
}

Figures figures_for(const ToolArguments& arguments, const ToolGeometry& found) {
  Figures markers = Figures::array(), sigmas = Figures::array();
  for (const Vector3& marker : found.markers_m) markers.push_back(figures_of(marker, 1e3));
  for (const double sigma : found.marker_sigma_m) sigmas.push_back(1e3 * sigma);
  return {{"source", source_of(arguments)},
          {"frame", arguments.recording.empty() ? "as in file" : "camera"},
          {"markers_mm", markers},
          {"marker_sigma_mm", sigmas},
          {"seen_in_frames", found.frame_counts},
          {"noise_mm", 1e3 * found.noise_m},
          {"scale", found.scale},
          {"drawn_rms_mm", 1e3 * found.drawn_rms_m},
          {"least_turn_deg", found.rotation_spread_rad * k_degrees_per_radian},
          {"frames", found.frames},
          {"frames_used", found.frames_used},
          {"points", found.points},
          {"points_used", found.points_used},
          {"segments", found.segments}};
}

std::vector<PointFrame> points_for(const ToolArguments& arguments, const Tool& tool,
                                   ToolGeometrySettings& settings,
                                   std::vector<std::string>& failures) {
  if (arguments.recording.empty()) return load_points(arguments.points);
  RecordedFrames recorded = open_recorded(arguments.recording, arguments.config);
  std::vector<PointFrame> points = recorded_points(recorded, tool, failures);
  settings.correlated_range_m = slow_range_of_mean(points, recorded.cell.camera);
  return points;
}

// Returns the tool whose markers are calibrated: that of --like, or a new one without markers.
Tool uncalibrated_tool(const ToolArguments& arguments) {
  if (!arguments.like.empty()) return named_tool(arguments.like);
  Tool tool;
  set_name(tool, arguments.name, "--name");
  tool.marker_radius_m = 1e-3 * arguments.radius_mm;
  tool.shape = arguments.shape == "disc" ? MarkerShape::disc : MarkerShape::sphere;
  return tool;
}

int run_tool(const ToolArguments& arguments) {
  if (arguments.points.empty() == arguments.recording.empty()) {
    throw InputError("calibrate tool: expected either --points FILE or --recording SOURCE");
  }
  Tool tool = uncalibrated_tool(arguments);  // throws before anything is computed
  ToolGeometrySettings settings;
  settings.noise_m = 1e-3 * arguments.noise_mm;
  settings.longest_side_m = 1e-3 * arguments.longest_side_mm;
  settings.longest_side_sigma_m = 1e-3 * arguments.longest_sigma_mm;
  if (!arguments.like.empty()) settings.drawn = tool;
  std::vector<std::string> failures;
  const std::string& source = source_of(arguments);
  const std::vector<PointFrame> points = points_for(arguments, tool, settings, failures);
  const ToolGeometry found = calibrate_tool(points, settings, source);

  tool.marker_count = 0;
  for (const Vector3& marker : found.markers_m) {
    tool.markers_m[static_cast<std::size_t>(tool.marker_count++)] = marker;
  }
  double squares = 0;
  for (const double sigma : found.marker_sigma_m) squares += sigma * sigma;
  tool.marker_sigma_m = std::sqrt(squares / static_cast<double>(found.marker_sigma_m.size()));
  std::vector<double> residuals_mm;
  for (const double residual : found.residuals_m) residuals_mm.push_back(1e3 * residual);
  const std::string from =
      "by glint calibrate tool from " + source +
      (settings.drawn ? ": tip as in the drawing (next: pivot)"
                      : ": origin at the markers' centroid, no tip (next: pivot)");
  finish_calibration(
      arguments.output, figures_for(arguments, found),
      {{file_name_of(tool) + ".toml", tool_toml_text(tool, from)},
       {"tool.svg", residual_plot({"Tool: rms distance of a frame's markers from the tool",
                                   "distance [mm]", residuals_mm})}});
  return report_losses(failures);
}

}  // namespace

void add_calibrate_tool(CLI::App& calibrate, int& exit_code) {
  CLI::App* command = calibrate.add_subcommand(
      "tool", "Calibrate the markers: about 300 frames of one tool, turned to all sides");
  auto arguments = std::make_shared<ToolArguments>();
  command->footer(
      "Examples:\n"
      "  glint calibrate tool --points markers.csv --name probe --longest-mm 88 --out out\n"
      "  glint calibrate tool --recording frames --config cell.toml --radius-mm 6 --name probe\n"
      "  glint calibrate tool --recording frames --config cell.toml --like pen.toml\n"
      "markers.csv: time_s,x_m,y_m,z_m, one unlabelled marker a row; missing markers and\n"
      "strays are allowed. --recording: all blobs with a range, in the camera's frame; "
      "--radius-mm\n"
      "and --shape give the distance of a centre from the surface. --like: the drawing gives the\n"
      "frame, the tip, the order of markers and, without --longest-mm, the size. The folder holds\n"
      "NAME.toml, for a cell's tools, and a plot.");
  command->add_option("--points", arguments->points, "marker positions (CSV)");
  add_recording_options(*command, arguments->recording, arguments->config);
  CLI::Option* like = command->add_option(
      "--like", arguments->like, "drawing of the tool: file (.toml, .rom, .ini) or pen (built in)");
  command->add_option("--name", arguments->name, "name of the tool")
      ->excludes(like)
      ->capture_default_str();
  command
      ->add_option("--longest-mm", arguments->longest_side_mm,
                   "known distance of the two markers farthest apart; 0: as measured")
      ->check(in_range(0.0, 2000.0));
  command
      ->add_option("--longest-sigma-mm", arguments->longest_sigma_mm,
                   "standard deviation of that distance")
      ->check(in_range(0.0, 100.0))
      ->capture_default_str();
  command
      ->add_option("--noise-mm", arguments->noise_mm,
                   "rough standard deviation of a marker an axis; it is estimated")
      ->check(in_range(0.01, 20.0))
      ->capture_default_str();
  command->add_option("--radius-mm", arguments->radius_mm, "radius of a marker in the tool file")
      ->check(in_range(0.0, 100.0))
      ->excludes(like)
      ->capture_default_str();
  command->add_option("--shape", arguments->shape, "shape of a marker in the tool file")
      ->check(CLI::IsMember({"sphere", "disc"}))
      ->excludes(like)
      ->capture_default_str();
  add_output_options(*command, arguments->output);
  command->callback([arguments, &exit_code] { exit_code = run_tool(*arguments); });
}

}  // namespace glint
