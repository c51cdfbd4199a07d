// Joint positions along the linear moves of a path, between its points and between its elements.
//
// A move is divided into equal steps. Each step is solved from the joint positions before it, so
// that the configuration does not change. A move that this does not lead to its end's joint
// positions is not followed: only its end is sampled, and the move is counted.
#pragma once

#include <cstdint>
#include <vector>

#include "platform/tools/programming/reach_check.hpp"

namespace glint {

struct MotionSteps {
  double distance_m = 0.005;
  double rotation_rad = 0.05;
};

// On the move to a point, or at it.
struct MotionSample {
  std::size_t element = 0, point = 0;  // from 1
  bool at_point = false;
  KDL::JntArray joints;
};

struct PathMotion {
  std::vector<MotionSample> samples;
  std::int64_t moves = 0;         // between two points, both with joint positions
  std::int64_t not_followed = 0;  // of them
};

// Equal steps of a move of this length and rotation. Throws InputError for more than 10,000.
[[nodiscard]] int step_count(double distance_m, double rotation_rad, const MotionSteps& steps);

// `followed` is the result of follow_path for this path. Throws InputError for a move of more than
// 10,000 steps.
[[nodiscard]] PathMotion path_motion(const DrawnPath& path, const FollowedPath& followed,
                                     const KinematicChain& chain, const PathCheckSettings& settings,
                                     const MotionSteps& steps);

}  // namespace glint
