#include "kernels/cloud/snap_to_planes.hpp"

namespace glint {

int snap_to_planes(const PlaneSearch& planes, const PlaneSupport& support, int from, int most,
                   PointCloud& points) noexcept {
  const int end = std::min(points.count, from + std::max(most, 0));
  for (int i = from; i < end; ++i) {
    const std::uint8_t on = support.plane_of(i);
    if (on == PlaneSearch::k_no_plane) continue;
    const Plane& plane = planes.plane(on);
    const Vector3 point(static_cast<double>(points.x[i]), static_cast<double>(points.y[i]),
                        static_cast<double>(points.z[i]));
    const Vector3 moved = point - (plane.normal.dot(point) - plane.offset_m) * plane.normal;
    points.x[i] = static_cast<float>(moved.x());
    points.y[i] = static_cast<float>(moved.y());
    points.z[i] = static_cast<float>(moved.z());
    points.normal_x[i] = static_cast<float>(plane.normal.x());
    points.normal_y[i] = static_cast<float>(plane.normal.y());
    points.normal_z[i] = static_cast<float>(plane.normal.z());
  }
  return end;
}

}  // namespace glint
