#include "platform/tools/calibrate/sightings.hpp"

#include <algorithm>
#include <memory>

#include "kernels/pose/correspond.hpp"
#include "kernels/pose/decide_labeling.hpp"

namespace glint {
namespace {

constexpr double k_pixel_sigma_px = 0.1;  // of a blob without a sigma, and the minimum of others
constexpr double k_gate_sigmas = 6;
constexpr double k_rms_sigmas = 3;
constexpr double k_any_area = 1e9;
// An error common to all ranges scales the whole tool: 10 mm at 0.3 m are 3 mm of 0.1 m.
constexpr double k_scale_tolerance_m = 0.003;
// A labeling is unambiguous if every alternative has a larger chi-square by this: three sigmas.
constexpr double k_ambiguity_chi_square = 9;

Markers markers_of(const BlobFrame& frame) {
  Markers markers;
  for (const ObservedBlob& blob : frame.blobs) {
    if (markers.count == k_blobs_max) break;
    Marker& marker = markers.items[static_cast<std::size_t>(markers.count)];
    marker.blob = static_cast<std::uint16_t>(markers.count++);
    marker.ray = blob.rays.ray;
    marker.centroid_px = blob.rays.pixel;
    marker.surface_range_m = blob.surface_range_m;
    marker.area_px = std::max<std::uint32_t>(blob.area_px, 1);
  }
  return markers;
}

MarkerObservations sights_of(const BlobFrame& frame, const ObservationSettings& settings) {
  MarkerObservations sights;
  for (std::size_t i = 0; i < std::min<std::size_t>(frame.blobs.size(), k_blobs_max); ++i) {
    const ObservedBlob& blob = frame.blobs[i];
    const double x = std::max(blob.sigma_x_px, k_pixel_sigma_px);
    const double y = std::max(blob.sigma_y_px, k_pixel_sigma_px);
    const double range = std::max(blob.sigma_range_m, settings.range_sigma_m);
    sights[i] = {blob.rays, {x * x, 0, y * y, range * range}};
  }
  return sights;
}

CorrespondSettings correspond_settings(const BlobSeries& series, const Tool& tool,
                                       const ObservationSettings& settings) {
  CorrespondSettings out;
  out.focal_px = series.camera.model.fx;
  const bool areas = !series.frames.empty() && !series.frames[0].blobs.empty() &&
                     series.frames[0].blobs[0].area_px > 0;
  if (!areas) out.area_factor = k_any_area;
  out.range_sigma_m = settings.range_sigma_m;
  out.gate_sigmas = k_gate_sigmas;
  out.delta_min_m = k_scale_tolerance_m;
  out.max_rms_m = k_rms_sigmas * settings.range_sigma_m;
  out.min_markers_without_prior = std::min(4, tool.marker_count);
  out.fewer_markers_max = 0;
  return out;
}

}  // namespace

ObservationSeries find_tool(const BlobSeries& series, const Tool& tool,
                            const ObservationSettings& settings) {
  ObservationSeries out;
  const CorrespondSettings correspond = correspond_settings(series, tool, settings);
  const auto scratch = std::make_unique<CorrespondScratch>();
  for (const BlobFrame& frame : series.frames) {
    ++out.frames;
    const Markers markers = markers_of(frame);
    const MarkerObservations sights = sights_of(frame, settings);
    Labelings labelings;
    (void)propose_labelings(markers, tool, correspond, nullptr, *scratch, labelings);
    const DecidedLabeling decided = decide_labeling(markers, sights, tool, labelings, nullptr, {});
    const bool ambiguous = decided.chosen >= 0 && decided.delta_chi_square < k_ambiguity_chi_square;
    if (decided.chosen < 0 || decided.reason != Reason::none || ambiguous) {
      ++out.unsolved;
      out.ambiguous += ambiguous ? 1 : 0;
      continue;
    }
    const Labeling& labeling = labelings.items[static_cast<std::size_t>(decided.chosen)];
    ToolObservation observation{{frame.time, decided.pose.T_camera_tool}, {}};
    for (int m = 0; m < tool.marker_count; ++m) {
      const std::int16_t seen = labeling.marker[static_cast<std::size_t>(m)];
      if (seen >= 0) {
        observation.markers.push_back({m, frame.blobs[static_cast<std::size_t>(seen)]});
      }
    }
    out.observations.push_back(std::move(observation));
  }
  return out;
}

}  // namespace glint
