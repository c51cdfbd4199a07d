#include "kernels/registration/render_depth.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace glint {
namespace {

using Corner = ProjectedCorner;

struct Box {
  int left, right, top, bottom;  // inclusive
};

// First pixel whose centre is at or right of u; clamped before the conversion to an integer.
int first_pixel(double u, int size) noexcept {
  const double clamped = std::clamp(u - 0.5, 0.0, static_cast<double>(size));
  const int whole = static_cast<int>(clamped);
  return whole < clamped ? whole + 1 : whole;
}
int last_pixel(double u, int size) noexcept {
  return static_cast<int>(std::clamp(u + 0.5, 0.0, static_cast<double>(size))) - 1;
}

Box box_of(const Corner (&c)[3], const Pinhole& camera) noexcept {
  return {first_pixel(std::min({c[0].u, c[1].u, c[2].u}), camera.width),
          last_pixel(std::max({c[0].u, c[1].u, c[2].u}), camera.width),
          first_pixel(std::min({c[0].v, c[1].v, c[2].v}), camera.height),
          last_pixel(std::max({c[0].v, c[1].v, c[2].v}), camera.height)};
}

double edge(const Corner& from, const Corner& to, double u, double v) noexcept {
  return (to.u - from.u) * (v - from.v) - (to.v - from.v) * (u - from.u);
}

void fill(const Corner (&c)[3], const Box& box, std::int32_t number, const Pinhole& camera,
          const DepthBuffer& buffer) noexcept {
  const double area = edge(c[0], c[1], c[2].u, c[2].v);
  if (!(std::abs(area) > 0)) return;
  const double scale = 1 / area;  // signed: renders both sides of a surface
  for (int y = box.top; y <= box.bottom; ++y) {
    for (int x = box.left; x <= box.right; ++x) {
      const double u = x + 0.5, v = y + 0.5;
      const double a = edge(c[1], c[2], u, v) * scale, b = edge(c[2], c[0], u, v) * scale;
      const double d = 1 - a - b;
      if (a < 0 || b < 0 || d < 0) continue;
      const auto z =
          static_cast<float>(1 / (a * c[0].inverse_z + b * c[1].inverse_z + d * c[2].inverse_z));
      const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) +
                      static_cast<std::size_t>(x);
      if (buffer.triangle[at] >= 0 && buffer.z_m[at] <= z) continue;
      buffer.z_m[at] = z;
      buffer.triangle[at] = number;
    }
  }
}

void project_corners(const Surface& model, const Pose& T_camera_model, const Pinhole& camera,
                     std::span<Corner> corners) noexcept {
  const Matrix3 rotation = T_camera_model.rotation.toRotationMatrix();
  for (std::size_t i = 0; i < model.corners.size(); ++i) {
    const Vector3 p = rotation * model.corners[i].cast<double>() + T_camera_model.translation;
    corners[i] = Corner{};
    if (!(p.z() > k_render_near_m)) continue;
    const double inverse = 1 / p.z();
    corners[i] = {camera.fx * p.x() * inverse + camera.cx, camera.fy * p.y() * inverse + camera.cy,
                  inverse};
  }
}

bool has(const Surface& model, std::int32_t corner) noexcept {
  return corner >= 0 && static_cast<std::size_t>(corner) < model.corners.size();
}

}  // namespace

Reason render_depth(const Surface& model, const Pose& T_camera_model, const Pinhole& camera,
                    const DepthBuffer& buffer) noexcept {
  const std::int64_t pixels = std::int64_t{camera.width} * camera.height;
  if (camera.width < 1 || camera.height < 1 ||
      buffer.z_m.size() != static_cast<std::size_t>(pixels) ||
      buffer.triangle.size() != buffer.z_m.size() || buffer.corners.size() < model.corners.size()) {
    return Reason::out_of_range;
  }
  std::fill(buffer.z_m.begin(), buffer.z_m.end(), 0.0f);
  std::fill(buffer.triangle.begin(), buffer.triangle.end(), -1);
  project_corners(model, T_camera_model, camera, buffer.corners);
  std::int64_t tests_left = pixels * k_render_tests_per_pixel;
  for (std::size_t i = 0; i < model.faces.size(); ++i) {
    const Face& face = model.faces[i];
    if (!has(model, face.a) || !has(model, face.b) || !has(model, face.c)) {
      return Reason::out_of_range;
    }
    const Corner c[3] = {buffer.corners[static_cast<std::size_t>(face.a)],
                         buffer.corners[static_cast<std::size_t>(face.b)],
                         buffer.corners[static_cast<std::size_t>(face.c)]};
    if (c[0].inverse_z == 0 || c[1].inverse_z == 0 || c[2].inverse_z == 0) continue;
    const Box box = box_of(c, camera);
    if (box.right < box.left || box.bottom < box.top) continue;
    tests_left -= std::int64_t{box.right - box.left + 1} * (box.bottom - box.top + 1);
    if (tests_left < 0) return Reason::search_full;
    fill(c, box, static_cast<std::int32_t>(i), camera, buffer);
  }
  return Reason::none;
}

}  // namespace glint
