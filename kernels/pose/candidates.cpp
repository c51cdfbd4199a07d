#include "kernels/pose/candidates.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr double k_pi = 3.14159265358979323846;

// A sphere of radius r at range z covers pi (f r / z)^2 pixels near the axis; a disc no more than
// that, and less when it is tilted: by up to 75 degrees, beyond which it no longer shines.
constexpr double k_disc_foreshortening = 0.26;

bool area_fits(const Marker& marker, double range_m, const Tool& tool,
               const CorrespondSettings& settings) {
  if (settings.focal_px <= 0 || tool.marker_radius_m <= 0 || marker.area_px == 0) return true;
  const double radius_px = settings.focal_px * tool.marker_radius_m / range_m;
  const double expected = k_pi * radius_px * radius_px;
  const double least = tool.shape == MarkerShape::disc ? k_disc_foreshortening : 1.0;
  const double area = marker.area_px;
  if (area < expected * least / settings.area_factor) {
    return (marker.flags & k_marker_touches_edge) != 0;
  }
  return area <= expected * settings.area_factor + k_area_slack_px;
}

}  // namespace

void select_candidates(const Markers& markers, const Tool& tool, const CorrespondSettings& settings,
                       Candidates& candidates) noexcept {
  candidates.count = 0;
  const int count = std::clamp(markers.count, 0, k_blobs_max);
  for (int m = 0; m < count; ++m) {
    const Marker& marker = markers.items[static_cast<std::size_t>(m)];
    if ((marker.flags & k_marker_no_depth) != 0) continue;
    const double range = marker.surface_range_m + tool.centre_offset_m();
    const Vector3 point = marker.ray * range;
    if (!(range > 0) || !std::isfinite(point.sum())) continue;
    if (!area_fits(marker, range, tool, settings)) continue;
    const double across = settings.focal_px > 0
                              ? range * settings.pixel_sigma_px / settings.focal_px
                              : settings.range_sigma_m;
    const auto slot = static_cast<std::size_t>(candidates.count++);
    candidates.point_m[slot] = point;
    candidates.ray[slot] = marker.ray;
    candidates.across_variance_m2[slot] = across * across;
    candidates.marker[slot] = static_cast<std::int16_t>(m);
  }
  candidates.words = (candidates.count + 63) / 64;
}

void match_pairs(const Candidates& candidates, const Tool& tool, const CorrespondSettings& settings,
                 PairMatches& matches) noexcept {
  struct ToolPair {
    std::size_t index;
    double distance_m;
  };
  std::array<ToolPair, k_tool_pairs_max> pairs{};
  std::size_t pair_count = 0;
  double longest = 0;
  for (int i = 0; i < tool.marker_count; ++i) {
    for (int j = i + 1; j < tool.marker_count; ++j) {
      const double distance =
          tool.distance_m[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      const std::size_t index = PairMatches::pair_index(i, j);
      pairs[pair_count++] = {index, distance};
      longest = std::max(longest, distance);
      for (int a = 0; a < candidates.count; ++a) {
        CandidateSet& set = matches.set[index][static_cast<std::size_t>(a)];
        for (int w = 0; w < candidates.words; ++w) set.word[static_cast<std::size_t>(w)] = 0;
      }
    }
  }

  const double range_variance = settings.range_sigma_m * settings.range_sigma_m;
  const double k = settings.gate_sigmas;
  double across_most = 0;
  for (int a = 0; a < candidates.count; ++a) {
    across_most = std::max(across_most, candidates.across_variance_m2[static_cast<std::size_t>(a)]);
  }
  // No gate is wider than this one, for a pair as long as the tool's longest.
  const double total_most = 2 * (range_variance + 2 * across_most);
  const double reach = longest + std::max(settings.delta_min_m,
                                          k * std::sqrt(total_most) + k * k * total_most / longest);
  for (int a = 0; a < candidates.count; ++a) {
    const auto ia = static_cast<std::size_t>(a);
    for (int b = a + 1; b < candidates.count; ++b) {
      const auto ib = static_cast<std::size_t>(b);
      const Vector3 between = candidates.point_m[ia] - candidates.point_m[ib];
      const double square = between.squaredNorm();
      if (square > reach * reach || !(square > 0)) continue;
      const double distance = std::sqrt(square);
      const double along_a = between.dot(candidates.ray[ia]) / distance;
      const double along_b = between.dot(candidates.ray[ib]) / distance;
      const double va = candidates.across_variance_m2[ia];
      const double vb = candidates.across_variance_m2[ib];
      const double along_variance = va + vb + (range_variance - va) * along_a * along_a +
                                    (range_variance - vb) * along_b * along_b;
      const double total_variance = 2 * (range_variance + va + vb);
      const double delta = std::max(settings.delta_min_m,
                                    k * std::sqrt(along_variance) +
                                        k * k * (total_variance - along_variance) / (2 * distance));
      for (std::size_t p = 0; p < pair_count; ++p) {
        if (!(std::abs(distance - pairs[p].distance_m) < delta)) continue;
        matches.set[pairs[p].index][ia].insert(b);
        matches.set[pairs[p].index][ib].insert(a);
      }
    }
  }
}

}  // namespace glint
