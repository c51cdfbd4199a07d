// Random tools and views of them, equal on every machine: splitmix64 by counter, normal values by
// Box and Muller 1958 with the core's own functions.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "kernels/elementary.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/correspond.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/tool.hpp"

namespace glint::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  double uniform() { return static_cast<double>((bits() >> 11) + 1) * 0x1p-53; }  // (0, 1]
  double within(double low, double high) { return low + (high - low) * uniform(); }
  int below(int n) { return static_cast<int>(bits() % static_cast<std::uint64_t>(n)); }
  double normal() {
    const double radius = std::sqrt(-2.0 * logarithm(uniform()));
    return radius * sine_cosine(6.283185307179586 * uniform()).cosine;
  }
  Vector3 vector(double sigma) {
    const double x = sigma * normal();
    const double y = sigma * normal();
    return {x, y, sigma * normal()};
  }
  Vector3 in_box(double side) {
    const double x = within(-side / 2, side / 2);
    const double y = within(-side / 2, side / 2);
    return {x, y, within(-side / 2, side / 2)};
  }
  Quaternion rotation() {
    const double a = normal(), b = normal(), c = normal(), d = normal();
    return Quaternion(a, b, c, d).normalized();
  }

 private:
  std::uint64_t state_;
};

// 64-bit FNV-1a hash over the bits of many numbers.
class BitHash {
 public:
  void add(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 8; ++i) hash_ = (hash_ ^ ((bits >> (8 * i)) & 0xFF)) * 0x100000001B3u;
  }
  void add(const Pose& pose) {
    for (int i = 0; i < 4; ++i) add(pose.rotation.coeffs()(i));
    for (int i = 0; i < 3; ++i) add(pose.translation(i));
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325u;
};

template <std::size_t N>
Tool tool_of(const Vector3 (&markers_mm)[N]) {
  Tool tool;
  for (std::size_t i = 0; i < N; ++i) tool.markers_m[i] = 1e-3 * markers_mm[i];
  tool.marker_count = static_cast<int>(N);
  tool.marker_radius_m = 0.0055;
  if (prepare_tool(tool) != Reason::none) tool.marker_count = 0;
  return tool;
}

// Five spheres; distances from 52 to 163 mm, which differ by at least 9.5 mm.
inline Tool five_marker_pen() {
  return tool_of<5>({{-2, 23, 232}, {-40, 45, 115}, {45, 45, 240}, {-8, -45, 115}, {22, 24, 129}});
}

inline Tool random_tool(Random& random, int markers) {
  for (;;) {
    Tool tool;
    tool.marker_count = markers;
    tool.marker_radius_m = 0.0055;
    for (int i = 0; i < markers; ++i) {
      tool.markers_m[static_cast<std::size_t>(i)] = random.in_box(0.16);
    }
    bool apart = prepare_tool(tool) == Reason::none;
    for (std::size_t i = 0; i < static_cast<std::size_t>(markers); ++i) {
      for (std::size_t j = 0; j < i; ++j) apart = apart && tool.distance_m[i][j] > 0.03;
    }
    if (apart) return tool;
  }
}

struct Scene {
  Markers markers;
  std::array<std::int16_t, k_markers_per_tool_max> truth{};  // -1: not in view
  Pose T_camera_tool;
};

struct SceneSettings {
  double range_sigma_m = 0.0015;
  double pixel_sigma_rad = 0.1 / 253;  // a tenth of an AHAT pixel
  double stray_box_m = 0.5;
  int strays = 0;
  int missing = 0;
};

inline void add_marker(Markers& markers, const Tool& tool, const Vector3& centre) {
  Marker& marker = markers.items[static_cast<std::size_t>(markers.count++)];
  marker = Marker{};
  marker.surface_range_m = centre.norm() - tool.centre_offset_m();
  marker.ray = centre.normalized();
}

// The tool at 0.5 m in a random orientation with stray reflections around it, in random order.
inline Scene scene_of(const Tool& tool, const SceneSettings& settings, Random& random) {
  Scene scene;
  scene.truth.fill(-1);
  Vector3 mean = Vector3::Zero();
  for (int i = 0; i < tool.marker_count; ++i) mean += tool.markers_m[static_cast<std::size_t>(i)];
  mean /= tool.marker_count;
  const Vector3 centre = random.in_box(0.2) + Vector3(0, 0, 0.5);
  scene.T_camera_tool.rotation = random.rotation();
  scene.T_camera_tool.translation = centre - scene.T_camera_tool.rotation * mean;
  std::array<std::pair<int, Vector3>, k_blobs_max> points;
  std::size_t count = 0;
  std::array<bool, k_markers_per_tool_max> hidden{};
  for (int k = 0; k < settings.missing; ++k) {
    int marker = random.below(tool.marker_count);
    while (hidden[static_cast<std::size_t>(marker)]) marker = (marker + 1) % tool.marker_count;
    hidden[static_cast<std::size_t>(marker)] = true;
  }
  for (int i = 0; i < tool.marker_count; ++i) {
    if (hidden[static_cast<std::size_t>(i)]) continue;
    const Vector3 point = scene.T_camera_tool * tool.markers_m[static_cast<std::size_t>(i)];
    const double across = settings.pixel_sigma_rad * point.norm();
    const Vector3 noise = random.vector(across);
    points[count++] = {
        i, point + noise + point.normalized() * (settings.range_sigma_m * random.normal())};
  }
  for (int i = 0; i < settings.strays; ++i) {
    points[count++] = {-1, centre + random.in_box(settings.stray_box_m)};
  }
  for (std::size_t k = count; k > 1; --k) {
    std::swap(points[k - 1], points[static_cast<std::size_t>(random.below(static_cast<int>(k)))]);
  }
  for (std::size_t k = 0; k < count; ++k) {
    const auto& [marker, point] = points[k];
    if (marker >= 0) {
      scene.truth[static_cast<std::size_t>(marker)] =
          static_cast<std::int16_t>(scene.markers.count);
    }
    add_marker(scene.markers, tool, point);
  }
  return scene;
}

inline double angle_between(const Quaternion& a, const Quaternion& b) {
  return rotation_vector(a * b.conjugate()).norm();
}

}  // namespace glint::test
