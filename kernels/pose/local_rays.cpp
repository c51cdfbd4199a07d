#include "kernels/pose/local_rays.hpp"

#include <algorithm>

namespace glint {
namespace {

constexpr int k_grid_cells = 128;  // in x and in y

Result<LocalRays> from_table(const CameraModel& camera, const Vector2& pixel, int& lens_steps) {
  LocalRays local;
  local.pixel = pixel;
  const auto look_up = [&](const Vector2& at) {
    const Result<Vector3> found = unproject(camera, at);
    lens_steps += found ? k_lens_steps_per_table_ray : 0;
    return found;
  };
  const Result<Vector3> middle = look_up(pixel);
  if (!middle) return {local, middle.reason};
  local.ray = middle.value;
  Vector3* const slopes[2] = {&local.along_x, &local.along_y};
  for (int axis = 0; axis < 2; ++axis) {
    // At the lens's rim only one of the two neighbours may have a ray.
    for (const double side : {1.0, -1.0}) {
      Vector2 beside = pixel;
      beside[axis] += side;
      const Result<Vector3> ray = look_up(beside);
      if (!ray) continue;
      const Vector3 change = (ray.value - local.ray) * side;
      *slopes[axis] = change - local.ray * local.ray.dot(change);
      break;
    }
  }
  local.set_outward({camera.cx, camera.cy});
  return {local};
}

}  // namespace

Result<LocalRays> local_rays(const CameraModel& camera, const Vector2& pixel, int steps_max,
                             int& lens_steps) noexcept {
  if (ray_search_of(camera.lens) == RaySearch::table) return from_table(camera, pixel, lens_steps);
  const Result<RayJacobian> turning = unproject_with_jacobian(camera, pixel, steps_max, lens_steps);
  const RayJacobian& found = turning.value;
  LocalRays local{pixel, found.ray, found.along_x, found.along_y};
  local.set_outward({camera.cx, camera.cy});
  return {local, turning.reason};
}

int ray_steps_needed(const CameraModel& camera) noexcept {
  switch (ray_search_of(camera.lens)) {
    case RaySearch::none:
      return 0;
    case RaySearch::table:
      return k_table_ray_steps;
    case RaySearch::newton:
      break;
  }
  int most = 0;
  // The grid contains the borders: the rim takes the most steps.
  for (int row = 0; row <= k_grid_cells; ++row) {
    for (int column = 0; column <= k_grid_cells; ++column) {
      const Vector2 pixel{static_cast<double>(column) * camera.width / k_grid_cells,
                          static_cast<double>(row) * camera.height / k_grid_cells};
      int steps = 0;
      if (unproject_with_jacobian(camera, pixel, k_ray_steps_max, steps))
        most = std::max(most, steps);
    }
  }
  return std::min(most + 1, k_ray_steps_max);
}

}  // namespace glint
