#include <algorithm>
#include <filesystem>
#include <memory>

#include "nodes/tracker.hpp"
#include "platform/calibrate/sightings.hpp"
#include "platform/cells/cell.hpp"
#include "platform/cells/toml_reader.hpp"
#include "platform/cells/tool_file.hpp"
#include "platform/input_error.hpp"
#include "platform/record/recording_reader.hpp"
#include "platform/session/pipeline.hpp"
#include "platform/session/recorded_cell.hpp"

namespace glint {
namespace {

// What is cut, merged, or has its range from its rim errs in ways of its own.
constexpr std::uint8_t k_spoiled = k_marker_no_depth | k_marker_ring_depth | k_marker_saturated |
                                   k_marker_touches_edge | k_marker_has_neighbour | k_marker_uneven;

// `blobs`: null where the recording has none.
BlobFrame frame_of(Time time, const Markers& markers, const Blobs* blobs, const Camera& camera) {
  BlobFrame frame{time, {}};
  for (int i = 0; i < markers.count; ++i) {
    const Marker& marker = markers.items[static_cast<std::size_t>(i)];
    if ((marker.flags & k_spoiled) != 0 || !(marker.surface_range_m > 0)) continue;
    int steps = 0;
    const Result<LocalRays> rays =
        local_rays(camera.model, marker.centroid_px, k_ray_steps_max, steps);
    if (!rays) continue;
    SeenBlob blob;
    blob.rays = rays.value;
    blob.surface_range_m = marker.surface_range_m;
    blob.sigma_x_px = static_cast<double>(marker.sigma_px[0]);
    blob.sigma_y_px = static_cast<double>(marker.sigma_px[1]);
    blob.sigma_range_m = static_cast<double>(marker.range_sigma_m);
    blob.area_px = marker.area_px;
    if (blobs != nullptr) blob.peak = blobs->items[marker.blob].peak;
    frame.blobs.push_back(blob);
  }
  return frame;
}

// Runs the tracker as the live run did, for the regions it searched are all that was kept.
class BlobFinder {
 public:
  BlobFinder(const Cell& cell, BlobSeries& series) : series_(series) {
    configure(cell, *tracker_);
    tracker_->latest<ToolSet>().set(cell.tools, 1, 0);
  }
  void take(const HeadPose& head) { tracker_->input<HeadPose>() = head; }
  void take(const FrameMessage& frame) {
    const Frame view = frame.view();
    tracker_->input<Frame>() = view;
    tracker_->activate();
    if (!tracker_->output<Estimates>().verdict.usable()) return;
    series_.frames.push_back(frame_of(frame.mid_exposure, tracker_->token<Markers>(),
                                      &tracker_->token<Blobs>(), series_.camera));
  }
  void take(const MarkerFrame& frame) {
    if (frame.reason != Reason::none) return;
    series_.frames.push_back(frame_of(frame.mid_exposure, frame.markers, nullptr, series_.camera));
  }
  template <class Other>
  void take(const Other&) {}

 private:
  BlobSeries& series_;
  std::unique_ptr<Tracker> tracker_ = std::make_unique<Tracker>();
};

BlobSeries recorded_blobs(const std::string& path) {
  RecordingReader reader(path);
  if (reader.level() == RecordingLevel::outputs) {
    throw InputError(path +
                     ": recorded at level outputs, which keeps nothing of the frames; "
                     "expected level blobs, roi or full ([record] level)");
  }
  Cell cell = recorded_cell(reader, path);
  if (reader.level() == RecordingLevel::blobs && cell.camera.depth.bias.range_max_m > 0) {
    throw InputError(path +
                     ": recorded at level blobs with a depth bias taken off already; "
                     "expected level roi or full, or a cell without camera.depth_bias");
  }
  cell.camera.depth.bias = {};
  BlobSeries series;
  series.what = path;
  series.camera = cell.camera;
  series.brightness = reader.level() != RecordingLevel::blobs;
  for (int t = 0; t < cell.tools.count; ++t)
    series.tools.push_back(cell.tools.items[static_cast<std::size_t>(t)]);
  BlobFinder finder(cell, series);
  while (const auto message = reader.next())
    std::visit([&](const auto& one) { finder.take(one); }, *message);
  return series;
}

}  // namespace

BlobSeries load_blobs(const std::string& path, const std::string& cell_file) {
  if (std::filesystem::path(path).extension() == ".mcap") return recorded_blobs(path);
  const Cell cell = cell_file.empty() ? default_cell() : load_cell(cell_file);
  return blobs_from_text(read_text(path), path, cell.camera);
}

Tool tool_of(const BlobSeries& series, const std::string& name) {
  const auto named = std::find_if(series.tools.begin(), series.tools.end(),
                                  [&](const Tool& tool) { return name == tool.name.data(); });
  if (named != series.tools.end()) return *named;
  if (name == "pen") return default_pen();
  if (!name.empty()) return load_tool(name);
  if (!series.tools.empty()) return series.tools.front();
  throw InputError(series.what + ": a table of blobs names no tool; expected --tool");
}

}  // namespace glint
