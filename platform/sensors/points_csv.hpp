// Marker positions without images: what any motion-capture system exports.
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

// The unlabelled marker centres of one instant.
struct PointFrame {
  Time time;
  std::vector<Vector3> points_m;
};

// Reads `time_s,x_m,y_m,z_m`, one marker a row, a heading of these names optional; rows of one time
// form a frame. Throws InputError with path and line for text, a number that is not finite, a stamp
// that runs backwards, a frame of more than k_blobs_max points, or a file without any.
[[nodiscard]] std::vector<PointFrame> load_points(const std::string& path);
[[nodiscard]] std::vector<PointFrame> points_from_text(std::string_view text,
                                                       const std::string& path);

// The points as candidate markers: rays from the origin, surface_range_m the distance, no area.
// They are centres, so the tool to look for among them is as_points(tool).
[[nodiscard]] Markers markers_from_points(const std::vector<Vector3>& points_m);

// The tool with markers of no size: a measured point is the centre, nothing lies behind a surface.
[[nodiscard]] Tool as_points(Tool tool);

// For positions of a motion-capture system: noise alike in all directions, no area gate.
[[nodiscard]] CorrespondSettings settings_for_points();

}  // namespace glint
