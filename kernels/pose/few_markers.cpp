#include "kernels/pose/few_markers.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/motion/cholesky.hpp"
#include "kernels/pose/blob_size.hpp"
#include "kernels/pose/chi_square_limit.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/marker_range.hpp"

namespace glint {
namespace {

using Gate = FewScratch::Gate;
constexpr std::uint8_t k_not_whole = k_marker_no_depth | k_marker_touches_edge | k_marker_uneven;

// Covariance of a marker's centre, from the variances of its pixel and its range.
Matrix3 centre_covariance(const MarkerSight& sight, double range_m) {
  const LocalRays& rays = sight.rays;
  const MarkerVariance& v = sight.variance;
  const Matrix3 mixed = rays.along_x * rays.along_y.transpose();
  const Matrix3 across = v.xx_px2 * (rays.along_x * rays.along_x.transpose()) +
                         v.yy_px2 * (rays.along_y * rays.along_y.transpose()) +
                         v.xy_px2 * (mixed + mixed.transpose());
  return (range_m * range_m) * across + v.range_m2 * (rays.ray * rays.ray.transpose());
}

void open_gate(const ExpectedTool& expected, int marker, const MarkerNoise& noise, Gate& gate,
               double& radius_m) {
  const Tool& tool = *expected.tool;
  const Vector3& model = tool.markers_m[static_cast<std::size_t>(marker)];
  gate = Gate{};
  gate.place_m = expected.T_camera_tool * model;
  const double range = gate.place_m.norm();
  radius_m = 1e9;
  gate.whiten = Matrix3::Identity() * 1e9;  // contains nothing
  if (!(range > 0)) return;
  Marker there;
  there.ray = gate.place_m / range;
  const Eigen::Matrix<double, 3, 6> j =
      point_by_pose(expected.T_camera_tool.rotation * (model - tool.middle_m()));
  const Matrix3 covariance = j * expected.covariance * j.transpose() +
                             centre_covariance(sight_of(there, range, noise), range);
  const Cholesky<3> factor(covariance);
  if (!factor.positive) return;
  for (int axis = 0; axis < 3; ++axis) gate.whiten.col(axis) = factor.forward(Vector3::Unit(axis));
  radius_m = std::sqrt(chi_square_limit(3) * largest_variance(covariance));
}

void open_gates(const ExpectedTool& expected, const MarkerNoise& noise,
                std::array<Gate, k_markers_per_tool_max>& gates) {
  const int count = expected.tool->marker_count;
  std::array<double, k_markers_per_tool_max> radius_m{};
  for (int m = 0; m < count; ++m) {
    const auto i = static_cast<std::size_t>(m);
    open_gate(expected, m, noise, gates[i], radius_m[i]);
  }
  for (std::size_t a = 0; a < static_cast<std::size_t>(count); ++a) {
    gates[a].apart = true;
    for (std::size_t b = 0; b < static_cast<std::size_t>(count); ++b) {
      const bool meets = a != b && radius_m[a] + radius_m[b] > expected.tool->distance_m[a][b];
      gates[a].apart = gates[a].apart && !meets;
    }
  }
}

NamedMarker measured(const Marker& marker, const Tool& tool, int of_tool,
                     const MarkerNoise& noise) {
  const double range = centre_range_m(marker, tool);
  MarkerSight sight = sight_of(marker, range, noise);
  CommonStrip common;  // one or two markers do not show the common rim offset
  common.add(0);
  widen(sight.variance, common.beyond(strip_px(marker, sight.rays, tool, range)));
  return {of_tool, marker.ray * range, centre_covariance(sight, range)};
}

// Test of the distance of two markers against the tool's, at significance level 1e-4.
bool fits(const NamedMarker& a, const NamedMarker& b, const Tool& tool) {
  const Vector3 between = b.centre_m - a.centre_m;
  const double length = between.norm();
  const double model =
      tool.distance_m[static_cast<std::size_t>(a.of_tool)][static_cast<std::size_t>(b.of_tool)];
  if (!(length > 0)) return false;
  const Vector3 along = between / length;
  const double variance = along.dot((a.covariance_m2 + b.covariance_m2) * along);
  return (length - model) * (length - model) <= chi_square_limit(1) * variance;
}

void name(const ExpectedTool& expected, const Markers& markers, const FewScratch& scratch,
          const std::array<Gate, k_markers_per_tool_max>& gates, const MarkerNoise& noise,
          FewMarkers& few) {
  const Tool& tool = *expected.tool;
  int filled = 0;
  for (int m = 0; m < tool.marker_count; ++m)
    filled += gates[static_cast<std::size_t>(m)].held > 0 ? 1 : 0;
  if (filled > k_few_max) return;
  for (int m = 0; m < tool.marker_count; ++m) {
    const Gate& gate = gates[static_cast<std::size_t>(m)];
    if (!gate.apart || gate.held != 1) continue;
    const auto at = static_cast<std::size_t>(gate.marker);
    if (scratch.claims[at] != 1 || (markers.items[at].flags & k_not_whole) != 0) continue;
    few.items[static_cast<std::size_t>(few.count++)] = measured(markers.items[at], tool, m, noise);
  }
  if (few.count == k_few_max && !fits(few.items[0], few.items[1], tool)) few.count = 0;
}

}  // namespace

FewWork name_few(std::span<const ExpectedTool> tools, const Markers& markers, int markers_max,
                 const TakenMarkers& taken, const MarkerNoise& noise, FewScratch& scratch,
                 std::span<FewMarkers> named) noexcept {
  FewWork work;
  const std::size_t tool_count =
      std::min({tools.size(), named.size(), static_cast<std::size_t>(k_tools_max)});
  const auto count = static_cast<std::size_t>(std::clamp(markers.count, 0, markers_max));
  scratch.claims.fill(0);
  for (std::size_t t = 0; t < tool_count; ++t) {
    named[t].count = 0;
    if (!tools[t].predicted) continue;
    auto& gates = scratch.gates[t];
    open_gates(tools[t], noise, gates);
    for (std::size_t i = 0; i < count; ++i) {
      ++work.tests;
      scratch.range_m[i] = centre_range_m(markers.items[i], *tools[t].tool);
    }
    for (int m = 0; m < tools[t].tool->marker_count; ++m) {
      Gate& gate = gates[static_cast<std::size_t>(m)];
      ++work.gates;
      for (std::size_t i = 0; i < count; ++i) {
        ++work.tests;
        const Vector3 residual =
            gate.whiten * (markers.items[i].ray * scratch.range_m[i] - gate.place_m);
        if (!(residual.squaredNorm() <= chi_square_limit(3))) continue;
        ++scratch.claims[i];
        if (taken[i]) continue;
        ++gate.held;
        gate.marker = static_cast<int>(i);
      }
    }
  }
  for (std::size_t t = 0; t < tool_count; ++t) {
    if (tools[t].predicted && tools[t].wanted)
      name(tools[t], markers, scratch, scratch.gates[t], noise, named[t]);
  }
  return work;
}

}  // namespace glint
