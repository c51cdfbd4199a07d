// The size of a tool whose markers were found, and the frame in which they are stated.
#pragma once

#include <string>
#include <vector>

#include "platform/calibrate/tool_geometry.hpp"

namespace glint {

[[nodiscard]] Vector3 middle_of(const std::vector<Vector3>& points);
[[nodiscard]] double longest_side(const std::vector<Vector3>& markers);

// The size that was measured apart, else the drawing's, else as it is. Its error moves each marker
// from the middle.
void set_size(const ToolGeometrySettings& settings, ToolGeometry& geometry);

// The drawing's frame and order of markers; else about their middle, along their principal axes.
// Throws InputError, naming `what`: another tool than the drawn one.
void set_frame(const ToolGeometrySettings& settings, const std::string& what,
               ToolGeometry& geometry);

}  // namespace glint
