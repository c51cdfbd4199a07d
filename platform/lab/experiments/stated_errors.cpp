#include "platform/lab/experiments/stated_errors.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace glint {

void draw_below_one_sigma(const Cell& cell, LargeError large, std::uint64_t seed,
                          sim::Scenario& scenario) {
  std::mt19937_64 random(seed);
  const auto even = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  const auto normal = [&] { return std::normal_distribution<double>()(random); };
  const CameraUncertainty& stated = cell.camera.uncertainty;
  sim::DeviceErrors& device = scenario.device;
  device.principal_point_px.x() = stated.principal_point_px * even();
  device.principal_point_px.y() = stated.principal_point_px * even();
  device.focal_scale = stated.focal_scale * even();
  device.range_scale = stated.range_scale * even();
  device.range_offset_m = stated.range_offset_m * even();
  if (large == LargeError::range_offset)
    device.range_offset_m = (even() > 0 ? 1 : -1) * k_large_sigmas * stated.range_offset_m;
  if (large == LargeError::range_scale)
    device.range_scale = (even() > 0 ? 1 : -1) * k_large_sigmas * stated.range_scale;
  if (large == LargeError::principal_point) {
    const double angle = std::numbers::pi * even();
    device.principal_point_px =
        k_large_sigmas * stated.principal_point_px * Vector2(std::cos(angle), std::sin(angle));
  }
  if (large == LargeError::focal_length)
    device.focal_scale = (even() > 0 ? 1 : -1) * k_large_sigmas * stated.focal_scale;
  scenario.timing.stamp_offset = {static_cast<std::int64_t>(1e9 * stated.time_stamp_s * even())};
  for (std::size_t t = 0; t < scenario.tools.size(); ++t) {
    Tool& actual = scenario.tools[t].tool;
    const Tool& nominal = cell.tools.items[t];
    for (int axis = 0; axis < 3; ++axis)
      actual.tip_m(axis) = nominal.tip_m(axis) + even() * nominal.tip_sigma_m;
    for (std::size_t i = 0; i < static_cast<std::size_t>(actual.marker_count); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const double sigmas =
            large == LargeError::tool_geometry ? k_large_sigmas * normal() : even();
        actual.markers_m[i](axis) = nominal.markers_m[i](axis) + sigmas * nominal.marker_sigma_m;
      }
    }
  }
  const double time_s = std::hypot(stated.time_stamp_s, cell.head_noise.time_stamp_s);
  scenario.localisation.latency_s = large == LargeError::time_offset
                                        ? (even() > 0 ? 1 : -1) * k_large_sigmas * time_s
                                        : cell.head_noise.time_stamp_s * even();
  const double drift = std::abs(even());
  set_drift_factor(large == LargeError::head_drift ? k_large_sigmas : drift, scenario.localisation);
}

void scale_drift(double factor, sim::LocalisationSettings& head) {
  for (double* part : {&head.rest_position_m, &head.rest_angle_rad, &head.position_per_speed_s,
                       &head.position_per_angular_speed_m, &head.angle_per_speed_s_m,
                       &head.angle_per_angular_speed_s})
    *part *= factor;
}

void set_drift_factor(double factor, sim::LocalisationSettings& head) {
  const sim::LocalisationSettings declared;
  head.rest_position_m = declared.rest_position_m;
  head.rest_angle_rad = declared.rest_angle_rad;
  head.position_per_speed_s = declared.position_per_speed_s;
  head.position_per_angular_speed_m = declared.position_per_angular_speed_m;
  head.angle_per_speed_s_m = declared.angle_per_speed_s_m;
  head.angle_per_angular_speed_s = declared.angle_per_angular_speed_s;
  scale_drift(factor, head);
}

}  // namespace glint
