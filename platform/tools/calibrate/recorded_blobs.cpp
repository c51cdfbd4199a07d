#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "kernels/pose/candidates.hpp"
#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/session/recorded_cell.hpp"
#include "platform/sinks/record/recording_reader.hpp"
#include "platform/sources/open_source.hpp"
#include "platform/tools/calibrate/sightings.hpp"
#include "platform/tools/calibrate/tool_geometry.hpp"
#include "platform/tools/inspect/recorded_frames.hpp"

namespace glint {
namespace {

// Markers that are cut off, merged, or ranged at their rim have errors of another kind.
constexpr std::uint8_t k_rejected_flags = k_marker_no_depth | k_marker_annulus_depth |
                                          k_marker_saturated | k_marker_touches_edge |
                                          k_marker_has_neighbour | k_marker_not_isolated;

// `blobs`: null if the recording has none.
BlobFrame frame_of(Time time, const Markers& markers, const Blobs* blobs, const Camera& camera) {
  BlobFrame frame{time, {}};
  for (int i = 0; i < markers.count; ++i) {
    const Marker& marker = markers.items[static_cast<std::size_t>(i)];
    if ((marker.flags & k_rejected_flags) != 0 || !(marker.surface_range_m > 0)) continue;
    int steps = 0;
    const Result<LocalRays> rays =
        local_rays(camera.model, marker.centroid_px, k_ray_steps_max, steps);
    if (!rays) continue;
    ObservedBlob blob;
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

BlobSeries series_for(Cell& cell, const std::string& path, const std::string& tool) {
  cell.camera.depth.bias = {};
  BlobSeries series;
  series.what = path;
  series.camera = cell.camera;
  series.tool = cell.tools.items[select_tool(cell, tool)];
  return series;
}

// For level blobs: the markers that the recorded run found.
BlobSeries recorded_markers(RecordingReader& reader, const std::string& path,
                            const std::string& tool) {
  Cell cell = recorded_cell(reader, path);
  if (cell.camera.depth.bias.range_max_m > 0) {
    throw InputError(path +
                     ": recorded at level blobs after depth bias correction; expected level roi or "
                     "full, or a cell without camera.depth_bias");
  }
  BlobSeries series = series_for(cell, path, tool);
  while (const auto message = reader.next()) {
    const auto* frame = std::get_if<MarkerFrame>(&*message);
    if (frame == nullptr || frame->reason != Reason::none) continue;
    series.frames.push_back(frame_of(frame->mid_exposure, frame->markers, nullptr, series.camera));
  }
  return series;
}

// Gives the blob search the marker kind of a tool whose marker positions are not known yet.
Tool placeholder_tool(Tool tool) {
  tool.markers_m = {Vector3{0, 0, 0}, Vector3{0.1, 0, 0}, Vector3{0, 0.07, 0}};
  tool.marker_count = 3;
  (void)prepare_tool(tool);
  return tool;
}

}  // namespace

BlobSeries recorded_blobs(const std::string& path, const std::string& cell_file,
                          const std::string& tool) {
  if (kind_at(path) == "recording") {
    RecordingReader reader(path);
    if (reader.level() == RecordingLevel::outputs) {
      throw InputError(path +
                       ": recorded at level outputs, without frames; expected level blobs, roi or "
                       "full ([record] level)");
    }
    if (reader.level() == RecordingLevel::blobs) return recorded_markers(reader, path, tool);
  }
  RecordedFrames recorded = open_recorded(path, cell_file);
  return recorded_blobs(recorded, tool);
}

BlobSeries recorded_blobs(RecordedFrames& recorded, const std::string& tool) {
  BlobSeries series = series_for(recorded.cell, recorded.path, tool);
  series.brightness = true;
  // Uses the live run's search: a recording of level roi holds only its regions.
  TrackedFrames tracked =
      track_frames(recorded, Search::tracked, [&](const ArrivedFrame& arrived, Tracker& tracker) {
        series.frames.push_back(frame_of(arrived.frame.mid_exposure, tracker.token<Markers>(),
                                         &tracker.token<Blobs>(), series.camera));
      });
  series.failures = std::move(tracked.failures);
  return series;
}

std::vector<PointFrame> recorded_points(RecordedFrames& recorded, const Tool& kind,
                                        std::vector<std::string>& failures) {
  set_only_tool(recorded.cell, placeholder_tool(kind));
  CorrespondSettings settings;
  settings.focal_px = recorded.cell.camera.model.fx;
  settings.range_min_m = recorded.cell.camera.range_min_m;
  settings.range_max_m = recorded.cell.camera.range_max_m;
  const auto candidates = std::make_unique<Candidates>();
  std::vector<PointFrame> frames;
  TrackedFrames tracked = track_frames(
      recorded, Search::everywhere, [&](const ArrivedFrame& arrived, Tracker& tracker) {
        // Rejects hot pixels by area and range.
        (void)select_candidates(tracker.token<Markers>(), kind, settings, nullptr, *candidates);
        const auto begin = candidates->point_m.begin();
        PointFrame frame{arrived.frame.mid_exposure, {begin, begin + candidates->count}};
        if (!frame.points_m.empty()) frames.push_back(std::move(frame));
      });
  failures = std::move(tracked.failures);
  return frames;
}

}  // namespace glint
