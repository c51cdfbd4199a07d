// A tool seen by a pinhole camera of AHAT's focal length, with noise on each marker.
#pragma once

#include <vector>

#include "kernels/pose/camera_model.hpp"
#include "kernels/pose/local_rays.hpp"
#include "kernels/pose/refine_pose.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint::test {

inline CameraModel pinhole() {
  CameraModel camera;
  camera.width = camera.height = 512;
  camera.fx = camera.fy = 253;
  camera.cx = camera.cy = 256;
  return camera;
}

// NDI's passive rigid body 8700339: four exactly coplanar spheres.
inline Tool flat_tool() {
  return tool_of<4>({{0, 0, 0}, {0, 28.59, 41.02}, {0, 0, 88}, {0, -44.32, 40.45}});
}

inline Vector3 mean_of_markers(const Tool& tool) {
  Vector3 mean = Vector3::Zero();
  for (int i = 0; i < tool.marker_count; ++i) mean += tool.markers_m[static_cast<std::size_t>(i)];
  return mean / tool.marker_count;
}

// The smallest rotation from the optical axis to `place`, which is in front of the camera.
inline Quaternion rotation_to(const Vector3& place) {
  const Vector3 ahead = Vector3::UnitZ();
  Quaternion half;  // 1 + cos and the cross product: twice cos(angle / 2) times the quaternion
  half.w() = 1 + ahead.dot(place.normalized());
  half.vec() = ahead.cross(place.normalized());
  return half.normalized();
}

// The tool's mean at `place`, its x axis at this angle to the line of sight.
inline Pose tilted_pose(const Tool& tool, double tilt_rad, const Vector3& place, Random& random) {
  const Quaternion facing = from_rotation_vector(Vector3(0, 1.5707963267948966, 0));
  const double around = random.within(0, 6.283185307179586);
  const SineCosine axis = sine_cosine(around);
  const Quaternion spin = from_rotation_vector(Vector3(0, 0, random.within(0, 6.28)));
  Pose pose;
  const Quaternion tilt = from_rotation_vector(tilt_rad * Vector3(axis.cosine, axis.sine, 0));
  pose.rotation = (rotation_to(place) * tilt * spin * facing).normalized();
  pose.translation = place - pose.rotation * mean_of_markers(tool);
  return pose;
}

// Each marker measured with noise of `variance`; noise 0: exact, with unchanged weights.
inline std::vector<WeightedMarker> weighted_view(const Tool& tool, const Pose& pose,
                                                 const MarkerVariance& variance, double noise,
                                                 Random& random) {
  std::vector<WeightedMarker> markers;
  const CameraModel camera = pinhole();
  for (int i = 0; i < tool.marker_count; ++i) {
    const Vector3& model = tool.markers_m[static_cast<std::size_t>(i)];
    const Vector3 point = pose * model;
    const double first = random.normal(), second = random.normal();
    const double length = std::sqrt(variance.xx_px2);
    const double across = variance.xy_px2 / length;
    Vector2 pixel = project(camera, point).value;
    pixel.x() += noise * length * first;
    pixel.y() += noise * (across * first + std::sqrt(variance.yy_px2 - across * across) * second);
    const double range = point.norm() + noise * std::sqrt(variance.range_m2) * random.normal();
    int lens_steps = 0;
    const LocalRays rays = local_rays(camera, pixel, k_ray_steps_max, lens_steps).value;
    markers.push_back(whiten_marker(model, rays, range, variance).value);
  }
  return markers;
}

}  // namespace glint::test
