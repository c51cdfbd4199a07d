// Marker positions without images: what any motion-capture system exports.
#pragma once

#include <string>
#include <vector>

#include "kernels/geometry.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/units.hpp"

namespace glint {

// The unlabelled markers of one instant.
struct PointFrame {
  Time time;
  std::vector<Vector3> points_m;
};

// Reads `time_s,x_m,y_m,z_m`, one marker a row, a heading optional; rows of one time form a frame.
// Throws InputError with path and line for text, a number that is not finite, a stamp that runs
// backwards, or a frame of more than k_blobs_max points.
[[nodiscard]] std::vector<PointFrame> load_points(const std::string& path);

// The same points as candidate markers: ray from the origin, no area, radius of zero.
[[nodiscard]] Markers markers_from_points(const PointFrame& frame);

}  // namespace glint
