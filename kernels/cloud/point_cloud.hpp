// Point cloud in columns: one array per coordinate, so that SIMD lanes process four points at once.
//
// Units: metres, in one frame that the user selects (a map: the headset's world). Normals are unit
// vectors perpendicular to the surface, of either sign, or zero if unknown. A point's weight is the
// number of measurements that it is the mean of.
#pragma once

#include "kernels/cloud/column.hpp"
#include "kernels/reason.hpp"

namespace glint {

// Capacity of a cloud; bounded by the 32-bit index of a sorted point.
inline constexpr int k_cloud_points_max = 1 << 24;

struct PointCloud {
  Column<float> x, y, z;
  Column<float> normal_x, normal_y, normal_z;
  Column<float> weight;
  int count = 0;
  int capacity = 0;

  [[nodiscard]] static constexpr std::size_t bytes(int points) noexcept {
    return 7 * Column<float>::bytes(points);
  }
  // Reason: none; out_of_range (capacity below 1 or above k_cloud_points_max); not_prepared (less
  // than bytes(points) left in the arena).
  [[nodiscard]] Reason prepare(int points, Arena& arena) noexcept {
    count = capacity = 0;
    if (points < 1 || points > k_cloud_points_max) return Reason::out_of_range;
    for (Column<float>* column : {&x, &y, &z, &normal_x, &normal_y, &normal_z, &weight}) {
      if (!column->reserve(points, arena)) return Reason::not_prepared;
    }
    capacity = points;
    return Reason::none;
  }

  // Adds a point without a normal. Returns false, and discards the point, if the cloud is full.
  [[nodiscard]] bool add(float px, float py, float pz, float measurements = 1) noexcept {
    if (count == capacity) return false;
    x[count] = px, y[count] = py, z[count] = pz;
    normal_x[count] = normal_y[count] = normal_z[count] = 0;
    weight[count++] = measurements;
    return true;
  }
};

}  // namespace glint
