#include "platform/tools/programming/user_frame.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"

namespace glint {
namespace {

void check_distance(double distance_m, const char* what) {
  if (distance_m >= k_frame_distance_min_m) return;
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "user frame: %s %.1f mm; expected %.0f mm or more", what,
                1e3 * distance_m, 1e3 * k_frame_distance_min_m);
  throw InputError(text.data());
}

const Vector3& waypoint_position(const DrawnPath& path, const std::string& name) {
  const auto at = std::find_if(path.begin(), path.end(), [&](const PathElement& element) {
    return element.name == name && element.kind == PathKind::waypoint;
  });
  if (at == path.end()) {
    throw InputError("user frame: no waypoint \"" + printable(name) +
                     "\" in the path; expected three names of waypoints");
  }
  return at->points.front().pose.translation;
}

}  // namespace

Pose frame_through(const Vector3& origin, const Vector3& on_x, const Vector3& in_plane) {
  if (!origin.allFinite() || !on_x.allFinite() || !in_plane.allFinite())
    throw InputError("user frame: a point that is not finite; expected three finite points");
  const Vector3 to_x = on_x - origin, to_plane = in_plane - origin;
  check_distance(to_x.norm(), "the distance from the origin to the point on +x is");
  check_distance(to_plane.norm(), "the distance from the origin to the point in the x-y plane is");
  const Vector3 x = to_x.normalized();
  const Vector3 across = to_plane - to_plane.dot(x) * x;
  check_distance(across.norm(),
                 "collinear points: the distance from the x axis to the point in the x-y plane is");
  Matrix3 axes;
  axes.col(0) = x;
  axes.col(1) = across.normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return {Quaternion(axes).normalized(), origin};
}

Pose user_frame(const DrawnPath& path, const std::vector<std::string>& names) {
  if (names[0] == names[1] || names[0] == names[2] || names[1] == names[2])
    throw InputError("user frame: a waypoint given twice; expected three different ones");
  return frame_through(waypoint_position(path, names[0]), waypoint_position(path, names[1]),
                       waypoint_position(path, names[2]));
}

DrawnPath without(DrawnPath path, const std::vector<std::string>& names) {
  std::erase_if(path, [&](const PathElement& element) {
    return std::find(names.begin(), names.end(), element.name) != names.end();
  });
  return path;
}

}  // namespace glint
