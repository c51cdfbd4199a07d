// Linear and circular moves of a stroke, made of its points or of the segments fitted to them.
#pragma once

#include <optional>
#include <vector>

#include "platform/tools/programming/stroke_segments.hpp"

namespace glint {

// A move of a stroke, to `pose` by a line, or by an arc through `via`. The first one is its begin.
struct StrokeMove {
  Pose pose;  // unit quaternion
  std::optional<Pose> via{};
};

// With settings: one move for each line, one or two for each arc. Corners are where two fitted
// segments meet. Without settings, and in free parts: one move for each point. Requires one point
// or more.
[[nodiscard]] std::vector<StrokeMove> stroke_moves(const std::vector<UncertainPose>& points,
                                                   const std::optional<SegmentSettings>& settings);

}  // namespace glint
