#include "kernels/pose/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kernels/pose/marker_range.hpp"

namespace glint {
namespace {

// A sphere of radius r at range z covers pi (f r / z)^2 pixels near the axis. A disc covers at most
// that, and less when tilted: by up to 75 degrees, beyond which it returns no light.
constexpr double k_disc_foreshortening = 0.26;

bool area_fits(const Marker& marker, double range_m, const Tool& tool,
               const CorrespondSettings& settings) {
  if (settings.focal_px <= 0 || tool.marker_radius_m <= 0 || marker.area_px == 0) return true;
  const double radius_px = settings.focal_px * tool.marker_radius_m / range_m;
  const double expected = std::numbers::pi * radius_px * radius_px;
  const double least = tool.shape == MarkerShape::disc ? k_disc_foreshortening : 1.0;
  const double area = marker.area_px;
  if (area < expected * least / settings.area_factor) {
    return (marker.flags & k_marker_touches_edge) != 0;
  }
  return area <= expected * settings.area_factor + k_area_slack_px;
}

bool range_fits(double range_m, const CorrespondSettings& settings) {
  if (settings.range_max_m <= 0) return true;
  return range_m * k_range_margin >= settings.range_min_m &&
         range_m <= settings.range_max_m * k_range_margin;
}

// Bit masks over the tool's markers: `point` is within each of the two gates of its predicted
// position.
struct GateMask {
  unsigned in_prior_gate = 0, in_partial_gate = 0;
};
GateMask near_mask(const std::array<Vector3, k_markers_per_tool_max>& predicted_m, int count,
                   const Vector3& point, double gate_m, double partial_gate_m) {
  GateMask mask;
  for (int j = 0; j < count; ++j) {
    const double square = (point - predicted_m[static_cast<std::size_t>(j)]).squaredNorm();
    mask.in_prior_gate |= static_cast<unsigned>(square <= gate_m * gate_m) << j;
    mask.in_partial_gate |= static_cast<unsigned>(square <= partial_gate_m * partial_gate_m) << j;
  }
  return mask;
}

void swap_candidates(Candidates& candidates, std::size_t a, std::size_t b) {
  std::swap(candidates.point_m[a], candidates.point_m[b]);
  std::swap(candidates.ray[a], candidates.ray[b]);
  std::swap(candidates.across_variance_m2[a], candidates.across_variance_m2[b]);
  std::swap(candidates.marker[a], candidates.marker[b]);
}

}  // namespace

int select_candidates(const Markers& markers, const Tool& tool, const CorrespondSettings& settings,
                      const Pose* prior_T_camera_tool, Candidates& candidates) noexcept {
  candidates.count = 0;
  std::array<Vector3, k_markers_per_tool_max> predicted_m;
  const int predicted = prior_T_camera_tool != nullptr ? tool.marker_count : 0;
  for (int j = 0; j < predicted; ++j) {
    const auto slot = static_cast<std::size_t>(j);
    predicted_m[slot] = *prior_T_camera_tool * tool.markers_m[slot];
  }
  std::array<std::uint8_t, k_blobs_max> in_prior_gate{}, in_partial_gate{};
  const double partial_gate_m = std::min(settings.partial_gate_m, settings.prior_gate_m);
  std::size_t first_far = 0;  // candidates before it are near the prediction
  const int count = std::clamp(markers.count, 0, settings.markers_max);
  for (int m = 0; m < count; ++m) {
    const Marker& marker = markers.items[static_cast<std::size_t>(m)];
    if ((marker.flags & k_marker_no_depth) != 0) continue;
    const double range = centre_range_m(marker, tool);
    const Vector3 point = marker.ray * range;
    if (!(range > 0) || !std::isfinite(point.sum())) continue;
    if (!range_fits(range, settings) || !area_fits(marker, range, tool, settings)) continue;
    const double across = settings.focal_px > 0
                              ? range * settings.pixel_sigma_px / settings.focal_px
                              : settings.range_sigma_m;
    const auto slot = static_cast<std::size_t>(candidates.count++);
    candidates.point_m[slot] = point;
    candidates.ray[slot] = marker.ray;
    candidates.across_variance_m2[slot] = across * across;
    candidates.marker[slot] = static_cast<std::int16_t>(m);
    const GateMask mask =
        near_mask(predicted_m, predicted, point, settings.prior_gate_m, partial_gate_m);
    in_prior_gate[slot] = static_cast<std::uint8_t>(mask.in_prior_gate);
    in_partial_gate[slot] = static_cast<std::uint8_t>(mask.in_partial_gate);
    if (mask.in_prior_gate == 0) continue;
    swap_candidates(candidates, slot, first_far);
    std::swap(in_prior_gate[slot], in_prior_gate[first_far]);
    std::swap(in_partial_gate[slot], in_partial_gate[first_far]);
    ++first_far;
  }
  candidates.words = (candidates.count + 63) / 64;
  candidates.in_prior_gate = {};
  candidates.in_partial_gate = {};
  for (std::size_t a = 0; a < first_far; ++a) {
    for (int j = 0; j < predicted; ++j) {
      const auto slot = static_cast<std::size_t>(j);
      candidates.in_prior_gate[slot].word[a / 64] |=
          static_cast<std::uint64_t>((in_prior_gate[a] >> j) & 1) << (a % 64);
      candidates.in_partial_gate[slot].word[a / 64] |=
          static_cast<std::uint64_t>((in_partial_gate[a] >> j) & 1) << (a % 64);
    }
  }
  return count;
}

}  // namespace glint
