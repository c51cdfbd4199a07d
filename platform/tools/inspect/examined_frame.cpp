#include "platform/tools/inspect/examined_frame.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "kernels/image/rescan.hpp"
#include "platform/runtime/session/pipeline.hpp"
#include "platform/tools/inspect/diagnosis.hpp"

namespace glint {
namespace {

std::uint16_t pixel_at(const Frame& frame, int x, int y) {
  return frame.reflectivity_8.empty() ? frame.reflectivity_16.row(y)[x]
                                      : std::uint16_t{frame.reflectivity_8.row(y)[x]};
}

// Finds the brightest pixel and the share of those above the threshold. A frame read from a
// recording does not state which pixels were recorded: at most the box of those that are not 0.
void measure_brightness(const Frame& frame, ExaminedFrame& examined) {
  std::size_t bright = 0;
  Roi box{frame.width(), frame.height(), 0, 0};
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) {
      const std::uint16_t pixel = pixel_at(frame, x, y);
      if (pixel == 0) continue;
      box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x + 1),
             std::max(box.y1, y + 1)};
      examined.brightest = std::max(examined.brightest, pixel);
      bright += pixel > examined.threshold ? 1 : 0;
    }
  }
  if (bright == 0) return;
  const auto box_px =
      static_cast<std::size_t>(box.x1 - box.x0) * static_cast<std::size_t>(box.y1 - box.y0);
  examined.bright_share = static_cast<double>(bright) / static_cast<double>(box_px);
}

Roi box_of(const auto& box) { return {box.x0, box.y0, box.x1, box.y1}; }

bool touches_edge(const Frame& frame, const Roi& box) {
  return box.x0 == 0 || box.y0 == 0 || box.x1 >= frame.width() || box.y1 >= frame.height();
}

std::string refusal_of(const Frame& frame, const Component& component,
                       const BlobSettings& settings) {
  if (component.area_px < settings.min_area_px) return "too_small";
  if (component.area_px > settings.max_area_px) return "too_large";
  const bool rescanned = component.level > 0;
  if (rescanned && !has_marker_contrast(frame, component)) return "low_contrast";
  return std::string(name_of(Reason::blobs_full));
}

}  // namespace

FrameExaminer::FrameExaminer(const Cell& cell) : cell_(cell), tools_(cell.tools) {
  configure(cell, *tracker_);
}

ExaminedFrame FrameExaminer::examine(const Frame& frame) {
  // A tool with a new identity is searched everywhere.
  ++searches_;
  for (Tool& tool : tools_.items) tool.identity = searches_;
  tracker_->latest<ToolSet>().set(tools_, searches_, 0);
  tracker_->input<Frame>() = frame;
  tracker_->activate();

  ExaminedFrame examined;
  examined.mid_exposure = frame.mid_exposure;
  examined.arrival = frame.arrival;
  examined.threshold = cell_.camera.threshold;
  if (tracker_->token<FrameStamp>().reason != Reason::none) return examined;
  examined.usable = true;
  measure_brightness(frame, examined);
  add_candidates(examined);
  add_refused(frame, examined);
  return examined;
}

void FrameExaminer::add_candidates(ExaminedFrame& examined) {
  const Blobs& blobs = tracker_->token<Blobs>();
  const Markers& markers = tracker_->token<Markers>();
  std::vector<const Marker*> marker_of(static_cast<std::size_t>(blobs.count), nullptr);
  for (int i = 0; i < markers.count; ++i) {
    const Marker& marker = markers.items[static_cast<std::size_t>(i)];
    if (marker.blob < marker_of.size()) marker_of[marker.blob] = &marker;
  }
  const std::vector<std::string> names = marker_names(cell_, *tracker_, "/");
  for (std::size_t i = 0; i < marker_of.size(); ++i) {
    const Blob& blob = blobs.items[i];
    ExaminedRegion region;
    region.centroid_px = blob.centroid_px;
    region.area_px = blob.area_px;
    region.peak = blob.peak;
    region.box = box_of(blob);
    region.marker = names[i];
    const bool has_depth =
        marker_of[i] != nullptr && (marker_of[i]->flags & k_marker_no_depth) == 0;
    if (has_depth) {
      region.range_m = marker_of[i]->surface_range_m;
      region.surface_m = marker_of[i]->ray * region.range_m;
    } else {
      region.reason = "no_depth";
    }
    ++(has_depth ? examined.counts.candidates : examined.counts.no_depth);
    examined.counts.touching_edge += (blob.flags & k_blob_touches_edge) != 0 ? 1 : 0;
    examined.regions.push_back(std::move(region));
  }
}

// Of a component that is no blob; 0: it has none.
double FrameExaminer::range_of(const Frame& frame, const Component& component,
                               const ExaminedRegion& region) const {
  const BackProject& depth = tracker_->node<BackProject>();
  Blob blob;
  blob.centroid_px = region.centroid_px;
  blob.area_px = component.area_px;
  blob.x0 = component.x0;
  blob.y0 = component.y0;
  blob.x1 = component.x1;
  blob.y1 = component.y1;
  Marker marker;
  const bool measured =
      measure_marker(frame, blob, 0, depth.camera, {}, depth.depth, depth.nominal, marker);
  return measured ? marker.surface_range_m : 0;
}

// Runs the blob search again, for the components that the tracker's own search discards.
void FrameExaminer::add_refused(const Frame& frame, ExaminedFrame& examined) {
  std::array<const Runs*, k_row_bands> bands;
  for (int i = 0; i < k_row_bands; ++i) {
    bands[static_cast<std::size_t>(i)] = &tracker_->parts<Runs>(i);
  }
  const FindBlobs& node = tracker_->node<FindBlobs>();
  (void)find_blobs(frame, bands, node.settings, {}, *scratch_, blobs_, node.limits);
  std::vector<bool> accepted(static_cast<std::size_t>(scratch_->component_count), false);
  for (int i = 0; i < blobs_.count; ++i) {
    accepted[scratch_->candidate[static_cast<std::size_t>(i)]] = true;
  }
  RegionCounts& counts = examined.counts;
  for (std::size_t i = 0; i < accepted.size(); ++i) {
    if (accepted[i] || examined.regions.size() == k_examined_regions_max) continue;
    const Component& component = scratch_->components[i];
    ExaminedRegion region;
    region.area_px = component.area_px;
    region.box = box_of(component);
    region.centroid_px = {0.5 * (region.box.x0 + region.box.x1),
                          0.5 * (region.box.y0 + region.box.y1)};
    for_each_run(*scratch_, component, [&](const RasterRun& run) {
      for (int x = run.x0(); x < run.x1(); ++x) {
        region.peak = std::max(region.peak, pixel_at(frame, x, run.y()));
      }
    });
    region.reason = refusal_of(frame, component, node.settings);
    counts.too_large += region.reason == "too_large" ? 1 : 0;
    if (region.reason == "too_small") {
      counts.touching_edge += touches_edge(frame, region.box) ? 1 : 0;
      region.range_m = range_of(frame, component, region);
      // Within the range a marker is large enough: a small spot there is none.
      const bool may_be_far = region.range_m > 0 ? region.range_m > 0.9 * cell_.camera.range_max_m
                                                 : component.area_px > 1;
      counts.too_small += may_be_far ? 1 : 0;
      if (may_be_far) counts.too_small_range_m = std::max(counts.too_small_range_m, region.range_m);
    }
    examined.regions.push_back(std::move(region));
  }
}

}  // namespace glint
