// User frame of a robot program, from three waypoints drawn with the pen.
#pragma once

#include <string>
#include <vector>

#include "platform/tools/programming/path.hpp"

namespace glint {

// Shorter distances between the points make the frame's rotation a result of their noise.
inline constexpr double k_frame_distance_min_m = 0.02;

// T_robot_user: its origin, x towards `on_x`, and y on the side of `in_plane` in the plane of the
// three points. Throws InputError for points that are not finite, for `on_x` or `in_plane` closer
// to the origin than the limit, and for `in_plane` closer to the x axis than the limit (collinear).
[[nodiscard]] Pose frame_through(const Vector3& origin, const Vector3& on_x,
                                 const Vector3& in_plane);

// T_robot_user of a path's waypoints at the origin, on +x and in the x-y plane. Requires three
// names. Throws InputError also for a name that is no waypoint of the path, or a name given twice.
[[nodiscard]] Pose user_frame(const DrawnPath& path, const std::vector<std::string>& names);

// The path without these elements: the robot does not move to the points of its frame.
[[nodiscard]] DrawnPath without(DrawnPath path, const std::vector<std::string>& names);

}  // namespace glint
