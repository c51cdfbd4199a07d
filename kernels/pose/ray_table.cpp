#include "kernels/pose/ray_table.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

// Interpolated ray and its derivatives by the pixel; not normalised.
struct Sample {
  Vector3 ray = Vector3::Zero();
  Vector3 along_x = Vector3::Zero(), along_y = Vector3::Zero();
  bool valid = false;
};

bool inside(const RayTable& table, const Vector2& pixel) {
  return table.rays != nullptr && table.width >= 2 && table.height >= 2 && pixel.x() >= 0 &&
         pixel.y() >= 0 && pixel.x() <= table.width && pixel.y() <= table.height;
}

Sample look_up(const RayTable& table, const Vector2& pixel) {
  Sample out;
  if (!inside(table, pixel)) return out;
  const double px = pixel.x() - 0.5, py = pixel.y() - 0.5;
  const int x = std::clamp(static_cast<int>(std::floor(px)), 0, table.width - 2);
  const int y = std::clamp(static_cast<int>(std::floor(py)), 0, table.height - 2);
  const double u = px - x, v = py - y;
  const double weights[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
  Vector3 corners[4];
  for (int i = 0; i < 4; ++i) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(y + i / 2) * table.width + x + i % 2;
    const float* ray = table.rays + 3 * at;
    corners[i] = {ray[0], ray[1], ray[2]};
    // At a pixel's own centre the neighbours have no weight: at the lens circle they have no ray.
    if (!(corners[i].z() > 0) && weights[i] != 0) return out;
  }
  for (int i = 0; i < 4; ++i) out.ray += weights[i] * corners[i];
  out.along_x = (1 - v) * (corners[1] - corners[0]) + v * (corners[3] - corners[2]);
  out.along_y = (1 - u) * (corners[2] - corners[0]) + u * (corners[3] - corners[1]);
  out.valid = out.ray.z() > 0;
  return out;
}

constexpr double k_step_max_px = 32;  // a cell's derivatives do not hold far away
constexpr double k_converged_px = 1e-9;

}  // namespace

Result<Vector3> unproject(const RayTable& table, const Vector2& pixel) noexcept {
  const Sample sample = look_up(table, pixel);
  if (!sample.valid) return {Vector3::Zero(), Reason::out_of_range};
  return {sample.ray / std::sqrt(sample.ray.squaredNorm())};
}

Result<Vector2> project(const RayTable& table, const Vector3& point, const Vector2& start,
                        const Vector2& middle, int& steps) noexcept {
  const Result<Vector2> none{Vector2::Zero(), Reason::out_of_range};
  if (!(point.z() > 0) || !inside(table, middle)) return none;
  const double tx = point.x() / point.z(), ty = point.y() / point.z();
  Vector2 last_valid = middle;
  Vector2 pixel{std::clamp(start.x(), 0.0, static_cast<double>(table.width)),
                std::clamp(start.y(), 0.0, static_cast<double>(table.height))};
  if (!inside(table, pixel)) pixel = middle;  // start is not a number
  for (int i = 0; i < k_lut_search_iterations_max; ++i) {
    ++steps;
    const Sample sample = look_up(table, pixel);
    if (!sample.valid) {
      pixel = 0.5 * (pixel + last_valid);
      continue;
    }
    last_valid = pixel;
    // Zero if the ray meets the point on the plane z = 1.
    const Vector2 miss{tx * sample.ray.z() - sample.ray.x(), ty * sample.ray.z() - sample.ray.y()};
    const double a = sample.along_x.x() - tx * sample.along_x.z();
    const double b = sample.along_y.x() - tx * sample.along_y.z();
    const double c = sample.along_x.y() - ty * sample.along_x.z();
    const double d = sample.along_y.y() - ty * sample.along_y.z();
    const double determinant = a * d - b * c;
    if (!(std::abs(determinant) > 1e-15)) return none;
    Vector2 step{(d * miss.x() - b * miss.y()) / determinant,
                 (a * miss.y() - c * miss.x()) / determinant};
    const double length = std::sqrt(step.squaredNorm());
    if (length <= k_converged_px) return {pixel};
    if (length > k_step_max_px) step *= k_step_max_px / length;
    pixel += step;
    pixel = {std::clamp(pixel.x(), 0.0, static_cast<double>(table.width)),
             std::clamp(pixel.y(), 0.0, static_cast<double>(table.height))};
  }
  return none;
}

}  // namespace glint
