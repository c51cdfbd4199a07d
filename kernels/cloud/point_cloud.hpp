// Points of a surface, each coordinate in a column of its own, so that four are worked on at once.
//
// Metres, in one frame, which is the user's to name (a map: the headset's world). Normals are unit
// vectors across the surface, of either sign, or zero where none is known. A point's weight is the
// number of measurements it is the mean of.
#pragma once

#include "kernels/cloud/column.hpp"
#include "kernels/reason.hpp"

namespace glint {

// The largest cloud that a kernel takes on: what 32 bits of a sorted point's place leave room for.
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
  // Reason: none; out_of_range for a capacity below 1 or above k_cloud_points_max; not_prepared
  // where the arena has less than bytes(points) left.
  [[nodiscard]] Reason prepare(int points, Arena& arena) noexcept {
    count = capacity = 0;
    if (points < 1 || points > k_cloud_points_max) return Reason::out_of_range;
    for (Column<float>* column : {&x, &y, &z, &normal_x, &normal_y, &normal_z, &weight}) {
      if (!column->reserve(points, arena)) return Reason::not_prepared;
    }
    capacity = points;
    return Reason::none;
  }

  // A point without a normal. False: full, and the point is left out.
  [[nodiscard]] bool add(float px, float py, float pz, float measurements = 1) noexcept {
    if (count == capacity) return false;
    x[count] = px, y[count] = py, z[count] = pz;
    normal_x[count] = normal_y[count] = normal_z[count] = 0;
    weight[count++] = measurements;
    return true;
  }
};

}  // namespace glint
