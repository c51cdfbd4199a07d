// Random tools and views of them, for the pose kernels' inputs.
#pragma once

#include "graph/latest.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/tool.hpp"
#include "nodes/tokens.hpp"
#include "platform/budget/inputs/numbers.hpp"

namespace glint::inputs {

// Markers in a box of 160 mm, at least 30 mm apart and not collinear; prepared.
[[nodiscard]] Tool any_tool(Numbers& numbers, int markers);

// Pose about half a metre in front of the camera, in view.
[[nodiscard]] Pose any_view(Numbers& numbers);

// Adds a candidate at `centre`; its surface range differs by the tool's centre offset.
void add_marker(Markers& markers, const Vector3& centre, const Tool& tool, int at_most);

// Adds the tool's markers with AHAT's range noise.
void add_tool(Markers& markers, const Tool& tool, const Pose& pose, double sigma_m,
              Numbers& numbers, int at_most);

// A pose that a hand can reach within 22 ms.
[[nodiscard]] Pose displaced(const Pose& from, Numbers& numbers);

// A verdict that accepts frame `sequence`.
[[nodiscard]] FrameVerdict accepted_verdict(std::uint64_t sequence);

}  // namespace glint::inputs
