// Size of a tool from its estimated markers, and the frame in which the markers are stated.
#pragma once

#include <string>
#include <vector>

#include "platform/tools/calibrate/tool_geometry.hpp"

namespace glint {

[[nodiscard]] Vector3 centroid_of(const std::vector<Vector3>& points);
[[nodiscard]] double longest_side(const std::vector<Vector3>& markers);

// Scales the markers to the measured longest side, else to the drawing's size, else not at all. The
// error of the size is added to each marker's sigma, along its line from the centroid.
void set_size(const ToolGeometrySettings& settings, ToolGeometry& geometry);

// Transforms to the drawing's frame and marker order; without a drawing, to the centroid and the
// principal axes. Throws InputError, naming `what`, for a tool other than the drawn one.
void set_frame(const ToolGeometrySettings& settings, const std::string& what,
               ToolGeometry& geometry);

}  // namespace glint
