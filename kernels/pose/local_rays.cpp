#include "kernels/pose/local_rays.hpp"

namespace glint {
namespace {

Result<LocalRays> from_table(const CameraModel& camera, const Vector2& pixel, int& lens_steps) {
  LocalRays local;
  local.pixel = pixel;
  const auto look_up = [&](const Vector2& at) {
    const Result<Vector3> found = unproject(camera, at);
    lens_steps += found ? k_lens_steps_a_ray_looked_up : 0;
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
  return {local};
}

}  // namespace

Result<LocalRays> local_rays(const CameraModel& camera, const Vector2& pixel,
                             int& lens_steps) noexcept {
  if (camera.lens == Lens::lut) return from_table(camera, pixel, lens_steps);
  const Result<TurningRay> turning = unproject_turning(camera, pixel, lens_steps);
  const TurningRay& found = turning.value;
  return {{pixel, found.ray, found.along_x, found.along_y}, turning.reason};
}

}  // namespace glint
