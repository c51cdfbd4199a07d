#include "kernels/pose/decide_labeling.hpp"

#include <algorithm>

#include "kernels/pose/marker_range.hpp"

namespace glint {
namespace {

struct Weighed {
  std::array<WeightedMarker, k_markers_per_tool_max> items;
  std::size_t count = 0;
  Reason reason = Reason::none;
};

Weighed weigh(const Markers& markers, const MarkerObservations& sights, const Tool& tool,
              const Labeling& labeling) {
  Weighed out;
  for (std::size_t i = 0; i < labeling.marker.size(); ++i) {
    if (labeling.marker[i] < 0) continue;
    const auto seen = static_cast<std::size_t>(labeling.marker[i]) % k_blobs_max;
    const MarkerMeasurementModel& sight = sights[seen];
    const double range = centre_range_m(markers.items[seen], tool);
    const Result<WeightedMarker> marker =
        whiten_marker(tool.markers_m[i], sight.rays, range, sight.variance);
    if (!marker) out.reason = marker.reason;
    out.items[out.count++] = marker.value;
  }
  return out;
}

}  // namespace

DecidedLabeling decide_labeling(const Markers& markers, const MarkerObservations& sights,
                                const Tool& tool, const Labelings& labelings,
                                const PosePrior* prior, const RefineSettings& settings) noexcept {
  DecidedLabeling out;
  const int count = std::clamp(labelings.count, 0, k_labelings_max);
  out.reason = count > 0 ? Reason::bad_fit : labelings.reason;
  if (count == 0 && out.reason == Reason::none) out.reason = Reason::no_labeling;
  // First pass: all markers of each labeling. Second pass, if none passes: one of its markers
  // removed.
  for (const int rejected_max : {0, settings.rejected_max}) {
    if (out.chosen >= 0) break;
    for (int k = 0; k < count; ++k) {
      const Labeling& labeling = labelings.items[static_cast<std::size_t>(k)];
      if (out.chosen >= 0 &&
          (rejected_max > 0 ||
           labeling.count < labelings.items[static_cast<std::size_t>(out.chosen)].count))
        break;
      const Weighed weighed = weigh(markers, sights, tool, labeling);
      if (weighed.reason != Reason::none) {
        out.reason = weighed.reason;
        continue;
      }
      RefineSettings as_decided = settings;
      as_decided.rejected_max = rejected_max;
      const RefinedPose pose =
          refine_pose({weighed.items.data(), weighed.count}, tool.tip_m, prior, as_decided);
      out.work += pose.work;
      if (pose.reason != Reason::none) continue;
      const double ahead = out.pose.chi_square - pose.chi_square;
      if (out.chosen >= 0 && ahead <= 0) {
        out.delta_chi_square = std::min(out.delta_chi_square, -ahead);
        continue;
      }
      if (out.chosen >= 0) out.delta_chi_square = ahead;
      out.chosen = k;
      out.pose = pose;
    }
    if (settings.rejected_max < 1) break;
  }
  if (out.chosen >= 0) out.reason = Reason::none;
  return out;
}

}  // namespace glint
