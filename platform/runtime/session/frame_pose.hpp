// Result of the frame group for one tool, with the covariance of the pose's own origin.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/image/frame.hpp"
#include "nodes/tracker.hpp"
#include "platform/sinks/record/trajectory_files.hpp"

namespace glint {

enum class PoseOrigin : std::uint8_t { tool, tip };

// The pose with its origin at the tool's own origin, or at its tip.
[[nodiscard]] Pose with_origin(const Pose& T_frame_tool, const Tool& tool, PoseOrigin origin);

// Call after `tracker` was activated with `frame`. `index`: of `tool` in the cell. The pose is in
// the world if the frame has a head pose, else in the camera's frame. FramePose::tool references
// the name in `tool`.
[[nodiscard]] FramePose frame_pose(const Frame& frame, Tracker& tracker, const Tool& tool,
                                   std::size_t index, PoseOrigin origin);

}  // namespace glint
