// glint inspect: what Glint sees in one frame, with a picture.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"
#include "platform/cells/tool_file.hpp"
#include "platform/cli/cell_option.hpp"
#include "platform/cli/commands.hpp"
#include "platform/cli/output_file.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/report/picture.hpp"
#include "platform/sensors/frame_files.hpp"
#include "platform/session/pipeline.hpp"

namespace glint {
namespace {

struct InspectArguments {
  std::string frame, layout = "adi", config, json, out = "out";
  std::vector<std::string> tools;
  int threshold = 0;
};

// A frame of another maker's camera comes without a calibration: a pinhole of this width.
constexpr double k_uncalibrated_degrees = 75.0;

Camera camera_for(FrameFileLayout layout, const FrameBuffer& pixels) {
  Camera camera = hololens2_ahat();
  if (layout != FrameFileLayout::adi) return camera;
  camera.name = "uncalibrated pinhole";
  camera.model = CameraModel{};
  camera.model.width = pixels.width;
  camera.model.height = pixels.height;
  camera.model.cx = 0.5 * pixels.width;
  camera.model.cy = 0.5 * pixels.height;
  camera.model.fx = camera.model.fy =
      camera.model.cx / std::tan(0.5 * k_uncalibrated_degrees * 3.14159265358979323846 / 180.0);
  camera.depth.wrap_range_m = 0;
  camera.depth.invalid_from = 0xFFFF;
  camera.range_max_m = 3.0;
  return camera;
}

nlohmann::ordered_json blob_json(const Blob& blob, const Marker* marker) {
  nlohmann::ordered_json item{{"x_px", blob.centroid_px.x()},
                              {"y_px", blob.centroid_px.y()},
                              {"area_px", blob.area_px},
                              {"peak", blob.peak},
                              {"saturated", (blob.flags & k_blob_saturated) != 0},
                              {"touches_edge", (blob.flags & k_blob_touches_edge) != 0},
                              {"has_neighbour", (blob.flags & k_blob_has_neighbour) != 0},
                              {"uneven", (blob.flags & k_blob_uneven) != 0},
                              {"sigma_x_px", std::sqrt(blob.variance_px2[0])},
                              {"sigma_y_px", std::sqrt(blob.variance_px2[1])}};
  if (marker != nullptr && (marker->flags & k_marker_no_depth) == 0) {
    item["range_m"] = marker->surface_range_m;
    item["range_sigma_m"] = marker->range_sigma_m;
    item["ring_depth"] = (marker->flags & k_marker_ring_depth) != 0;
    item["wrapped"] = (marker->flags & k_marker_wrapped) != 0;
  }
  return item;
}

const Marker* marker_of(const Markers& markers, int blob) {
  for (int i = 0; i < markers.count; ++i) {
    const Marker& marker = markers.items[static_cast<std::size_t>(i)];
    if (marker.blob == blob) return &marker;
  }
  return nullptr;
}

nlohmann::ordered_json tool_json(const Tool& tool, const Track& track) {
  const Vector3& t = track.T_camera_tool.translation;
  const Quaternion& q = track.T_camera_tool.rotation;
  const Vector3 tip = track.T_camera_tool * tool.tip_m;
  return {{"name", std::string(tool.name.data())},
          {"position_m", {t.x(), t.y(), t.z()}},
          {"rotation_xyzw", {q.x(), q.y(), q.z(), q.w()}},
          {"tip_m", {tip.x(), tip.y(), tip.z()}},
          {"marker_mask", track.marker_mask},
          {"rms_mm", track.rms_m * 1e3}};
}

int inspect_frame(const InspectArguments& arguments) {
  const FrameFileLayout layout = frame_file_layout_of(arguments.layout);
  const FrameBuffer pixels = load_frame(arguments.frame, layout);
  Cell cell = cell_or_default(arguments.config);
  if (arguments.config.empty()) set_camera(cell, camera_for(layout, pixels));
  if (arguments.threshold > 0) {
    cell.camera.threshold = static_cast<std::uint16_t>(arguments.threshold);
  }
  if (!arguments.tools.empty()) cell.tools = ToolSet{};
  for (const std::string& file : arguments.tools) {
    if (cell.tools.count == k_tools_max) {
      throw InputError("--tool " + file + ": expected at most " + std::to_string(k_tools_max));
    }
    const std::optional<Tool> built_in = built_in_tool(file);
    cell.tools.items[static_cast<std::size_t>(cell.tools.count++)] =
        built_in ? *built_in : load_tool(file);
  }

  auto tracker = std::make_unique<Tracker>();
  configure(cell, *tracker);
  tracker->latest<ToolSet>().set(cell.tools, 1, 0);
  tracker->input<Frame>() = pixels.view(Time{} + milliseconds(1), Time{} + milliseconds(1), 1);
  tracker->activate();

  const Blobs& blobs = tracker->token<Blobs>();
  const Markers& markers = tracker->token<Markers>();
  nlohmann::ordered_json blob_list = nlohmann::ordered_json::array();
  for (int i = 0; i < blobs.count; ++i) {
    blob_list.push_back(blob_json(blobs.items[static_cast<std::size_t>(i)], marker_of(markers, i)));
  }
  nlohmann::ordered_json found = nlohmann::ordered_json::array();
  nlohmann::ordered_json reasons = nlohmann::ordered_json::array();
  std::vector<std::string> lines;
  const Estimates& estimates = tracker->output<Estimates>();
  for (int t = 0; t < cell.tools.count; ++t) {
    const auto i = static_cast<std::size_t>(t);
    const Track& track = estimates.tracks[i];
    const std::string name = cell.tools.items[i].name.data();
    const std::string reason(name_of(track.reason));
    if (track.seen_now) found.push_back(tool_json(cell.tools.items[i], track));
    reasons.push_back({{"tool", name}, {"reason", reason}});
    lines.push_back(name + ": " + (track.seen_now ? "found" : reason));
    std::printf("%-16s %s\n", printable(name).c_str(), track.seen_now ? "found" : reason.c_str());
  }
  std::printf("%-16s %d (and %u outside the size gate, %u beyond the budget)\n", "blobs",
              blobs.count, blobs.dropped - blobs.left_out, blobs.left_out);

  make_folder(arguments.out);
  const std::string picture = (std::filesystem::path(arguments.out) /
                               (std::filesystem::path(arguments.frame).stem().string() + ".png"))
                                  .string();
  write_picture(picture, tracker->input<Frame>(), tracker->token<Rois>(), blobs, markers, lines);
  std::printf("%-16s %s\n", "picture", picture.c_str());
  write_json(arguments.json, {{"frame", arguments.frame},
                              {"layout", arguments.layout},
                              {"threshold", cell.camera.threshold},
                              {"tools", found},
                              {"reasons", reasons},
                              {"blobs", blob_list},
                              {"blobs_dropped", blobs.dropped},
                              {"blobs_left_out", blobs.left_out},
                              {"picture", picture}});
  return 0;
}

}  // namespace

void add_inspect(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("inspect", "Show what Glint sees in one frame");
  auto arguments = std::make_shared<InspectArguments>();
  command->footer(
      "Example: glint inspect --frame frame.bin --layout adi --tool pen --json seen.json\n"
      "The picture goes to --out, named after the frame.");
  command->add_option("--frame", arguments->frame, "a frame file")->required();
  command->add_option("--layout", arguments->layout,
                      "adi: depth u16, confidence u8, brightness u16 planes; ahat: depth and "
                      "brightness u16 planes; pgm: NAME.pgm beside NAME_ab.pgm");
  command->add_option("--tool", arguments->tools, "tool files, or pen (built in)");
  add_cell_option(*command, arguments->config, "cell file with camera and tools");
  command->add_option("--threshold", arguments->threshold, "reflectivity of a marker, raw counts")
      ->check(in_range(1, 65534));
  command->add_option("--out", arguments->out, "folder of the picture")->capture_default_str();
  command->add_option("--json", arguments->json, "write what was seen here");
  command->callback([arguments, &exit_code] { exit_code = inspect_frame(*arguments); });
}

}  // namespace glint
