#include "platform/runtime/session/labelled_markers.hpp"

#include "kernels/pose/marker_range.hpp"
#include "platform/runtime/session/pipeline.hpp"

namespace glint {

LabelledMarkers::LabelledMarkers(const Markers& all, const Labeling& labeling, const Tool& tool,
                                 const MarkerNoise& noise, unsigned rejected_flags) noexcept {
  for (int i = 0; i < tool.marker_count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (labeling.marker[at] < 0) continue;
    const Marker& marker = all.items[static_cast<std::size_t>(labeling.marker[at])];
    if ((marker.flags & rejected_flags) != 0) continue;
    const double range_m = centre_range_m(marker, tool);
    const MarkerMeasurementModel sight = measurement_model(marker, range_m, noise);
    const Result<WeightedMarker> weighed =
        whiten_marker(tool.markers_m[at], sight.rays, range_m, sight.variance);
    if (!weighed) continue;
    markers_[count_] = weighed.value;
    rays_[count_] = sight.rays;
    of_tool_[count_++] = i;
  }
}

MarkerNoise noise_of(const NoiseEstimate& estimate, const Camera& camera) noexcept {
  return noise_now(estimate, declared_noise(camera));
}

}  // namespace glint
