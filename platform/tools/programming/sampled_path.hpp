// Points along the moves that a program writes for a path with fitted shapes, for the checks: the
// drawn points are not on these moves.
#pragma once

#include "platform/tools/programming/path_motion.hpp"
#include "platform/tools/programming/stroke_moves.hpp"

namespace glint {

// Each stroke's points are replaced by poses on its moves, at most one step apart. An arc is the
// circle through its three positions. Waypoints stay. Times and covariances of the poses are 0.
// Throws InputError for a move of too many steps.
[[nodiscard]] DrawnPath sampled_path(const DrawnPath& path, const SegmentSettings& shapes,
                                     const MotionSteps& steps);

}  // namespace glint
