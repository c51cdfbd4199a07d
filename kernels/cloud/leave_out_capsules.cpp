#include "kernels/cloud/leave_out_capsules.hpp"

#include <algorithm>

namespace glint {
namespace {

// Returns false for NaN: every comparison with NaN is false.
bool within(const ExclusionCapsule& capsule, const Vector3& point) noexcept {
  const Vector3 along = capsule.to - capsule.from, off = point - capsule.from;
  const double length = along.squaredNorm();
  const double share = length > 0 ? std::clamp(off.dot(along) / length, 0.0, 1.0) : 0.0;
  const double squared = (off - share * along).squaredNorm();
  return capsule.radius_m > 0 && squared <= capsule.radius_m * capsule.radius_m;
}

}  // namespace

int leave_out_capsules(std::span<const ExclusionCapsule> capsules, int first,
                       PointCloud& points) noexcept {
  const auto looked_at =
      capsules.first(std::min<std::size_t>(capsules.size(), k_exclusion_capsules_max));
  int kept = std::max(first, 0);
  const int count = points.count;
  for (int i = kept; i < count; ++i) {
    const Vector3 point(static_cast<double>(points.x[i]), static_cast<double>(points.y[i]),
                        static_cast<double>(points.z[i]));
    bool inside = false;
    for (const ExclusionCapsule& capsule : looked_at) inside = inside || within(capsule, point);
    if (inside) continue;
    for (Column<float>* column : {&points.x, &points.y, &points.z, &points.normal_x,
                                  &points.normal_y, &points.normal_z, &points.weight}) {
      (*column)[kept] = (*column)[i];
    }
    ++kept;
  }
  points.count = std::min(kept, count);
  return count - points.count;
}

}  // namespace glint
