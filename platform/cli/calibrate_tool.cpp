// glint calibrate tool: where the markers of a new tool are, from it in motion.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "nodes/tracker.hpp"
#include "platform/calibrate/say.hpp"
#include "platform/calibrate/tool_geometry.hpp"
#include "platform/cells/tool_formats.hpp"
#include "platform/cells/tool_writer.hpp"
#include "platform/cli/calibrate_commands.hpp"
#include "platform/cli/output_file.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/session/frame_source.hpp"
#include "platform/tools/recorded_frames.hpp"

namespace glint {
namespace {

struct ToolArguments {
  std::string points, recording, config, name = "tool", shape = "sphere";
  double radius_mm = 5.75, longest_mm = 0, noise_mm = 1.0;
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
          {"seen_in_frames", found.seen},
          {"noise_mm", 1e3 * found.noise_m},
          {"scale", found.scale},
          {"least_turn_deg", found.turn_rad * k_degrees_per_radian},
          {"frames", found.frames},
          {"frames_used", found.frames_used},
          {"points", found.points},
          {"points_used", found.points_used},
          {"segments", found.segments}};
}

// What the search for blobs needs of a tool whose markers are yet to be found: their kind.
Tool stand_in(Tool tool) {
  tool.markers_m = {Vector3{0, 0, 0}, Vector3{0.1, 0, 0}, Vector3{0, 0.07, 0}};
  tool.marker_count = 3;
  (void)prepare_tool(tool);
  return tool;
}

// In the camera's frame: a rigid tool needs no head pose.
std::vector<PointFrame> recorded_points(const ToolArguments& arguments, const Tool& tool,
                                        std::vector<std::string>& failures) {
  RecordedFrames recorded = open_recorded(arguments.recording, arguments.config);
  set_only_tool(recorded.cell, stand_in(tool));
  std::vector<PointFrame> frames;
  TrackedFrames tracked = track_frames(
      recorded, Search::everywhere, [&](const ArrivedFrame& arrived, Tracker& tracker) {
        PointFrame frame{arrived.frame.mid_exposure,
                         marker_centres(tracker.token<Markers>(), tool)};
        if (!frame.points_m.empty()) frames.push_back(std::move(frame));
      });
  failures = std::move(tracked.failures);
  return frames;
}

int run_tool(const ToolArguments& arguments) {
  if (arguments.points.empty() == arguments.recording.empty()) {
    throw InputError("calibrate tool: expected either --points FILE or --recording SOURCE");
  }
  Tool tool;  // refused for its name before anything is computed
  set_name(tool, arguments.name, "--name");
  tool.marker_radius_m = 1e-3 * arguments.radius_mm;
  tool.shape = arguments.shape == "disc" ? MarkerShape::disc : MarkerShape::sphere;
  ToolGeometrySettings settings;
  settings.noise_m = 1e-3 * arguments.noise_mm;
  settings.longest_side_m = 1e-3 * arguments.longest_mm;
  std::vector<std::string> failures;
  const std::string& source = source_of(arguments);
  const ToolGeometry found =
      calibrate_tool(arguments.recording.empty() ? load_points(arguments.points)
                                                 : recorded_points(arguments, tool, failures),
                     settings, source);

  for (const Vector3& marker : found.markers_m) {
    tool.markers_m[static_cast<std::size_t>(tool.marker_count++)] = marker;
  }
  double squares = 0;
  for (const double sigma : found.marker_sigma_m) squares += sigma * sigma;
  tool.marker_sigma_m = std::sqrt(squares / static_cast<double>(found.marker_sigma_m.size()));
  std::vector<double> residuals_mm;
  for (const double residual : found.residuals_m) residuals_mm.push_back(1e3 * residual);
  const std::string from = "by glint calibrate tool from " + source +
                           ": about the markers' middle; the tip is not known yet (pivot)";
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
      "tool", "The markers: about 300 frames of the tool alone, turned to all sides");
  auto arguments = std::make_shared<ToolArguments>();
  command->footer(
      "Examples:\n"
      "  glint calibrate tool --points markers.csv --name probe --longest-mm 88 --out out\n"
      "  glint calibrate tool --recording frames --config cell.toml --radius-mm 6 --name probe\n"
      "markers.csv: time_s,x_m,y_m,z_m, one unlabelled marker a row; some may be missing, strays\n"
      "may be among them. --recording: all blobs with a range, in the camera's frame; --radius-mm\n"
      "and --shape are then what their centres lie behind the surface by. The folder gets "
      "NAME.toml, for a cell's tools, and a plot.");
  command->add_option("--points", arguments->points, "marker positions (CSV)");
  add_recording_options(*command, arguments->recording, arguments->config);
  command->add_option("--name", arguments->name, "of the tool")->capture_default_str();
  command
      ->add_option("--longest-mm", arguments->longest_mm,
                   "the known distance of the two markers farthest apart; 0: as measured")
      ->check(in_range(0.0, 2000.0));
  command
      ->add_option("--noise-mm", arguments->noise_mm,
                   "of a measured marker, an axis, roughly; it is found anew")
      ->check(in_range(0.01, 20.0))
      ->capture_default_str();
  command->add_option("--radius-mm", arguments->radius_mm, "of a marker, for the tool file")
      ->check(in_range(0.0, 100.0))
      ->capture_default_str();
  command->add_option("--shape", arguments->shape, "of a marker, for the tool file")
      ->check(CLI::IsMember({"sphere", "disc"}))
      ->capture_default_str();
  add_output_options(*command, arguments->output);
  command->callback([arguments, &exit_code] { exit_code = run_tool(*arguments); });
}

}  // namespace glint
