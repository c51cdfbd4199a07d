#include "kernels/pose/local_rays.hpp"

namespace glint {

Result<LocalRays> local_rays(const CameraModel& camera, const Vector2& pixel) noexcept {
  LocalRays local;
  local.pixel = pixel;
  const Result<Vector3> middle = unproject(camera, pixel);
  if (!middle) return {local, middle.reason};
  local.ray = middle.value;
  Vector3* const slopes[2] = {&local.along_x, &local.along_y};
  for (int axis = 0; axis < 2; ++axis) {
    // At the lens's rim only one of the two neighbours may have a ray.
    for (const double side : {1.0, -1.0}) {
      Vector2 beside = pixel;
      beside[axis] += side;
      const Result<Vector3> ray = unproject(camera, beside);
      if (!ray) continue;
      const Vector3 change = (ray.value - local.ray) * side;
      *slopes[axis] = change - local.ray * local.ray.dot(change);
      break;
    }
  }
  return {local};
}

}  // namespace glint
