#include "platform/tools/robot/primitives.hpp"

#include <cmath>

namespace glint {
namespace {

// 48 corners: the flat sides of a cylinder of 10 cm are at most 0.2 mm inside it.
constexpr int k_corners = 48;

Vector3f on_circle(int corner, double radius_m, double z_m) {
  const double angle = 2 * M_PI * (corner % k_corners) / k_corners;  // closed ring
  return Eigen::Vector3d(radius_m * std::cos(angle), radius_m * std::sin(angle), z_m).cast<float>();
}

// Triangles between two rings of corners.
void add_band(std::vector<Triangle>& out, double low_radius, double low_z, double high_radius,
              double high_z) {
  for (int k = 0; k < k_corners; ++k) {
    const Vector3f a = on_circle(k, low_radius, low_z), b = on_circle(k + 1, low_radius, low_z);
    const Vector3f c = on_circle(k, high_radius, high_z), d = on_circle(k + 1, high_radius, high_z);
    if (low_radius > 0) out.push_back({a, b, d});
    if (high_radius > 0) out.push_back({a, d, c});
  }
}

}  // namespace

std::vector<Triangle> box_surface(const Eigen::Vector3d& size_m) {
  std::vector<Triangle> out;
  const Vector3f half = (0.5 * size_m).cast<float>();
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      Vector3f u = Vector3f::Zero(), v = Vector3f::Zero(), n = Vector3f::Zero();
      n(axis) = side * half(axis);
      u((axis + 1) % 3) = half((axis + 1) % 3);
      v((axis + 2) % 3) = side * half((axis + 2) % 3);
      out.push_back({n - u - v, n + u - v, n + u + v});
      out.push_back({n - u - v, n + u + v, n - u + v});
    }
  }
  return out;
}

std::vector<Triangle> cylinder_surface(double radius_m, double length_m) {
  std::vector<Triangle> out;
  add_band(out, 0, -length_m / 2, radius_m, -length_m / 2);
  add_band(out, radius_m, -length_m / 2, radius_m, length_m / 2);
  add_band(out, radius_m, length_m / 2, 0, length_m / 2);
  return out;
}

std::vector<Triangle> sphere_surface(double radius_m) {
  std::vector<Triangle> out;
  constexpr int bands = k_corners / 2;
  for (int k = 0; k < bands; ++k) {
    const double low = M_PI * k / bands, high = M_PI * (k + 1) / bands;
    add_band(out, k == 0 ? 0 : radius_m * std::sin(low), -radius_m * std::cos(low),
             k + 1 == bands ? 0 : radius_m * std::sin(high), -radius_m * std::cos(high));
  }
  return out;
}

}  // namespace glint
