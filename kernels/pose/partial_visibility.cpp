#include "kernels/pose/partial_visibility.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/motion/cholesky.hpp"
#include "kernels/pose/blob_size.hpp"
#include "kernels/pose/chi_square_limit.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/marker_range.hpp"

namespace glint {
namespace {

using Gate = PartialScratch::Gate;
constexpr std::uint8_t k_not_isolated =
    k_marker_no_depth | k_marker_touches_edge | k_marker_not_isolated;

// Covariance of a marker's centre, from the variances of its pixel and its range.
Matrix3 centre_covariance(const MarkerMeasurementModel& sight, double range_m) {
  const LocalRays& rays = sight.rays;
  const MarkerVariance& v = sight.variance;
  const Matrix3 mixed = rays.along_x * rays.along_y.transpose();
  const Matrix3 across = v.xx_px2 * (rays.along_x * rays.along_x.transpose()) +
                         v.yy_px2 * (rays.along_y * rays.along_y.transpose()) +
                         v.xy_px2 * (mixed + mixed.transpose());
  return (range_m * range_m) * across + v.range_m2 * (rays.ray * rays.ray.transpose());
}

void open_gate(const PredictedTool& expected, int marker, const MarkerNoise& noise, Gate& gate,
               double& radius_m) {
  const Tool& tool = *expected.tool;
  const Vector3& model = tool.markers_m[static_cast<std::size_t>(marker)];
  gate = Gate{};
  gate.predicted_m = expected.T_camera_tool * model;
  const double range = gate.predicted_m.norm();
  radius_m = 1e9;
  gate.whitening = Matrix3::Identity() * 1e9;  // contains nothing
  if (!(range > 0)) return;
  Marker there;
  there.ray = gate.predicted_m / range;
  const Eigen::Matrix<double, 3, 6> j =
      point_by_pose(expected.T_camera_tool.rotation * (model - tool.middle_m()));
  const Matrix3 covariance = j * expected.covariance * j.transpose() +
                             centre_covariance(measurement_model(there, range, noise), range);
  const Cholesky<3> factor(covariance);
  if (!factor.positive) return;
  for (int axis = 0; axis < 3; ++axis)
    gate.whitening.col(axis) = factor.forward(Vector3::Unit(axis));
  radius_m = std::sqrt(chi_square_limit(3) * largest_variance(covariance));
}

void open_gates(const PredictedTool& expected, const MarkerNoise& noise,
                std::array<Gate, k_markers_per_tool_max>& gates) {
  const int count = expected.tool->marker_count;
  std::array<double, k_markers_per_tool_max> radius_m{};
  for (int m = 0; m < count; ++m) {
    const auto i = static_cast<std::size_t>(m);
    open_gate(expected, m, noise, gates[i], radius_m[i]);
  }
  for (std::size_t a = 0; a < static_cast<std::size_t>(count); ++a) {
    gates[a].is_disjoint = true;
    for (std::size_t b = 0; b < static_cast<std::size_t>(count); ++b) {
      const bool meets = a != b && radius_m[a] + radius_m[b] > expected.tool->distance_m[a][b];
      gates[a].is_disjoint = gates[a].is_disjoint && !meets;
    }
  }
}

IdentifiedMarker measured(const Marker& marker, const Tool& tool, int of_tool,
                          const MarkerNoise& noise) {
  const double range = centre_range_m(marker, tool);
  MarkerMeasurementModel sight = measurement_model(marker, range, noise);
  CommonRimOffset common;  // one or two markers do not show the common rim offset
  common.add(0);
  inflate(sight.variance, common.beyond(rim_offset_px(marker, sight.rays, tool, range)));
  return {of_tool, marker.ray * range, centre_covariance(sight, range)};
}

// Test of the distance of two markers against the tool's, at significance level 1e-4.
bool fits(const IdentifiedMarker& a, const IdentifiedMarker& b, const Tool& tool) {
  const Vector3 between = b.centre_m - a.centre_m;
  const double length = between.norm();
  const double model =
      tool.distance_m[static_cast<std::size_t>(a.of_tool)][static_cast<std::size_t>(b.of_tool)];
  if (!(length > 0)) return false;
  const Vector3 along = between / length;
  const double variance = along.dot((a.covariance_m2 + b.covariance_m2) * along);
  return (length - model) * (length - model) <= chi_square_limit(1) * variance;
}

void name(const PredictedTool& expected, const Markers& markers, const PartialScratch& scratch,
          const std::array<Gate, k_markers_per_tool_max>& gates, const MarkerNoise& noise,
          PartialMarkers& few) {
  const Tool& tool = *expected.tool;
  int filled = 0;
  for (int m = 0; m < tool.marker_count; ++m)
    filled += gates[static_cast<std::size_t>(m)].free_count > 0 ? 1 : 0;
  if (filled > k_partial_markers_max) return;
  for (int m = 0; m < tool.marker_count; ++m) {
    const Gate& gate = gates[static_cast<std::size_t>(m)];
    if (!gate.is_disjoint || gate.free_count != 1) continue;
    const auto at = static_cast<std::size_t>(gate.marker);
    if (scratch.gate_count[at] != 1 || (markers.items[at].flags & k_not_isolated) != 0) continue;
    few.items[static_cast<std::size_t>(few.count++)] = measured(markers.items[at], tool, m, noise);
  }
  if (few.count == k_partial_markers_max && !fits(few.items[0], few.items[1], tool)) few.count = 0;
}

}  // namespace

PartialWork identify_partial(std::span<const PredictedTool> tools, const Markers& markers,
                             int markers_max, const TakenMarkers& taken, const MarkerNoise& noise,
                             PartialScratch& scratch, std::span<PartialMarkers> named) noexcept {
  PartialWork work;
  const std::size_t tool_count =
      std::min({tools.size(), named.size(), static_cast<std::size_t>(k_tools_max)});
  const auto count = static_cast<std::size_t>(std::clamp(markers.count, 0, markers_max));
  scratch.gate_count.fill(0);
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
            gate.whitening * (markers.items[i].ray * scratch.range_m[i] - gate.predicted_m);
        if (!(residual.squaredNorm() <= chi_square_limit(3))) continue;
        ++scratch.gate_count[i];
        if (taken[i]) continue;
        ++gate.free_count;
        gate.marker = static_cast<int>(i);
      }
    }
  }
  for (std::size_t t = 0; t < tool_count; ++t) {
    if (tools[t].predicted && tools[t].needs_labeling)
      name(tools[t], markers, scratch, scratch.gates[t], noise, named[t]);
  }
  return work;
}

}  // namespace glint
