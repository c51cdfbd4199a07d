// Tools and views of them, as the pose kernels' inputs are made of.
#pragma once

#include "graph/latest.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/tool.hpp"
#include "nodes/tokens.hpp"
#include "platform/budget/inputs/numbers.hpp"

namespace glint::inputs {

// Markers in a box of 160 mm, 30 mm apart and on no line; prepared.
[[nodiscard]] Tool any_tool(Numbers& numbers, int markers);

// Half a metre in front of the camera, in view.
[[nodiscard]] Pose any_view(Numbers& numbers);

// A candidate at `centre`, its surface as far before it as the tool's markers have it.
void add_marker(Markers& markers, const Vector3& centre, const Tool& tool, int at_most);

// The tool's markers as a camera with AHAT's noise sees them.
void add_tool(Markers& markers, const Tool& tool, const Pose& pose, double sigma_m,
              Numbers& numbers, int at_most);

// Where a hand may have carried it 22 ms on.
[[nodiscard]] Pose moved(const Pose& from, Numbers& numbers);

// A verdict that admits frame `sequence`.
[[nodiscard]] FrameVerdict admitted(std::uint64_t sequence);

}  // namespace glint::inputs
