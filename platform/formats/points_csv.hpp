// Reader of marker positions without images, as exported by a motion-capture system (CSV).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kernels/geometry.hpp"
#include "kernels/pose/correspond.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/tool.hpp"
#include "kernels/units.hpp"

namespace glint {

// Unlabelled marker centres of one instant.
struct PointFrame {
  Time time;
  std::vector<Vector3> points_m;
};

// Reads `time_s,x_m,y_m,z_m`, one marker per row, with an optional header line of these names. Rows
// of equal time form a frame. Throws InputError with path and line for text, a non-finite number, a
// decreasing time stamp, a frame of more than k_blobs_max points, or a file without points.
[[nodiscard]] std::vector<PointFrame> load_points(const std::string& path);
[[nodiscard]] std::vector<PointFrame> points_from_text(std::string_view text,
                                                       const std::string& path);

// Returns the points as candidate markers: rays from the origin, surface_range_m the distance, no
// area. The points are centres, so search for as_points(tool).
[[nodiscard]] Markers markers_from_points(const std::vector<Vector3>& points_m);

// Returns the tool with markers of zero size: a measured point is the centre, not a surface.
[[nodiscard]] Tool as_points(Tool tool);

// For a motion-capture system: isotropic noise, no area gate.
[[nodiscard]] CorrespondSettings settings_for_points();

}  // namespace glint
