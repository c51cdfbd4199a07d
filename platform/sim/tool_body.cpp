#include "platform/sim/tool_body.hpp"

#include <cmath>
#include <utility>

#include "kernels/elementary.hpp"
#include "platform/sim/scene.hpp"

namespace glint::sim {
namespace {

constexpr int k_directions = 200;
constexpr int k_tilts = 8;
constexpr double k_tilt = 0.44;  // radians: 25 degrees
constexpr double k_golden_angle = 2.399963229728653;
constexpr double k_post_m = 0.015;
constexpr double k_shaft_radius_m = 0.005;
constexpr double k_clear_m = 0.006;  // between two silhouettes: 3 px at 0.5 m
constexpr double k_hand_below_m = 0.045;

const Vector3& marker(const Tool& tool, int i) {
  return tool.markers_m[static_cast<std::size_t>(i)];
}

Vector3 perpendicular_to(const Vector3& axis) {
  const Vector3 other = std::abs(axis.x()) < 0.7 ? Vector3::UnitX() : Vector3::UnitY();
  return axis.cross(other).normalized();
}

// Apparent distance between a marker and a shaft that passes in front of it; otherwise large.
double gap_to_shaft(const Tool& tool, const Vector3& middle, int i, const Vector3& direction) {
  const Vector3 along = middle - tool.tip_m;
  const Vector3 seen_along = along - along.dot(direction) * direction;
  const Vector3 from_start = marker(tool, i) - (tool.tip_m - k_post_m * direction);
  const double length2 = seen_along.squaredNorm();
  double u = length2 > 0 ? from_start.dot(seen_along) / length2 : 0;
  u = u < 0 ? 0 : u > 1 ? 1 : u;
  const Vector3 to_marker = from_start - u * along;
  return to_marker.dot(direction) > 0 ? 1.0 : to_marker.cross(direction).norm();
}

// Returns the number of markers separate from this direction, plus the smallest gap (tie-break).
double separate_markers(const Tool& tool, const Vector3& middle, const Vector3& direction) {
  const double apart = 2 * tool.marker_radius_m + k_clear_m;
  const double beside = tool.marker_radius_m + k_shaft_radius_m + 0.2 * k_clear_m;
  double clear = 0, least = 1;
  for (int i = 0; i < tool.marker_count; ++i) {
    double gap = 1;
    for (int j = 0; j < tool.marker_count; ++j) {
      if (i == j) continue;
      const double distance = (marker(tool, i) - marker(tool, j)).cross(direction).norm();
      if (distance < gap) gap = distance;
    }
    if (gap >= apart && gap_to_shaft(tool, middle, i, direction) >= beside) clear += 1;
    if (gap < least) least = gap;
  }
  return clear + least;  // gap in metres: far below one marker
}

double score(const Tool& tool, const Vector3& middle, const Vector3& direction) {
  const Vector3 right = perpendicular_to(direction), up = direction.cross(right);
  double sum = separate_markers(tool, middle, direction);
  for (int i = 0; i < 2 * k_tilts; ++i) {
    const SineCosine tilt = sine_cosine(i % 2 == 0 ? k_tilt : 0.5 * k_tilt);
    const SineCosine turn = sine_cosine(3.141592653589793 * i / k_tilts);
    sum += separate_markers(
        tool, middle, tilt.cosine * direction + tilt.sine * (turn.cosine * right + turn.sine * up));
  }
  return sum;
}

// Normal of the largest triangle: viewing direction of flat discs.
Vector3 plane_normal(const Tool& tool) {
  Vector3 best = Vector3::UnitX();
  double largest = 0;
  for (int i = 2; i < tool.marker_count; ++i) {
    for (int j = 1; j < i; ++j) {
      const Vector3 area =
          (marker(tool, i) - marker(tool, 0)).cross(marker(tool, j) - marker(tool, 0));
      if (area.norm() <= largest) continue;
      largest = area.norm();
      best = area / largest;
    }
  }
  return best;
}

}  // namespace

Grip best_grip(const Tool& tool) {
  Grip grip;
  grip.centroid = centroid_of(tool);
  if (tool.shape == MarkerShape::disc) {
    grip.towards_camera = plane_normal(tool);
  } else {
    double best = -1;
    for (int i = 0; i < k_directions; ++i) {  // Fibonacci sphere
      const double z = 1 - (2.0 * i + 1) / k_directions;
      const SineCosine turn = sine_cosine(k_golden_angle * i);
      const double across = std::sqrt(1 - z * z);
      const Vector3 direction(across * turn.cosine, across * turn.sine, z);
      const double value = score(tool, grip.centroid, direction);
      if (value <= best) continue;
      best = value;
      grip.towards_camera = direction;
    }
  }
  const Vector3 stick = grip.centroid - tool.tip_m;
  const Vector3 across = stick - stick.dot(grip.towards_camera) * grip.towards_camera;
  grip.up =
      across.norm() > 0.01 ? Vector3(across.normalized()) : perpendicular_to(grip.towards_camera);
  return grip;
}

Pose grip_pose(const Grip& grip, const Vector3& place, const Vector3& camera) {
  const Vector3 back = (camera - place).normalized();
  const Vector3 right = Vector3::UnitZ().cross(back).normalized();
  Matrix3 world, tool;
  world.col(0) = back;
  world.col(1) = back.cross(right);
  world.col(2) = world.col(0).cross(world.col(1));
  tool.col(0) = grip.towards_camera;
  tool.col(1) = grip.up;
  tool.col(2) = tool.col(0).cross(tool.col(1));
  const Quaternion rotation = Quaternion(Matrix3(world * tool.transpose())).normalized();
  return {rotation, place - rotation * grip.centroid};
}

ToolBody held_tool(const Tool& tool, const Grip& grip, const SignalSettings& signal,
                   MotionPointer motion) {
  ToolBody body;
  body.tool = tool;
  body.motion = std::move(motion);
  body.disc_normal = grip.towards_camera;
  double lowest = 0;  // along up, from the centroid
  for (int i = 0; i < tool.marker_count; ++i) {
    const double height = (marker(tool, i) - grip.centroid).dot(grip.up);
    if (height < lowest) lowest = height;
  }
  const Vector3 behind = -k_post_m * grip.towards_camera;
  const Vector3 side = grip.up.cross(grip.towards_camera);
  const Vector3 hold = grip.centroid + (lowest - k_hand_below_m) * grip.up + behind;
  body.parts.push_back(
      {tool.tip_m + behind, grip.centroid + behind, k_shaft_radius_m, signal.pen_body});
  const Vector3 palm = hold + 0.045 * side - 0.025 * grip.up;
  body.parts.push_back({palm, palm + 0.03 * side - 0.03 * grip.up, 0.032, signal.skin});
  for (int finger = 0; finger < 3; ++finger) {
    const Vector3 knuckle = palm + (0.02 - 0.018 * finger) * grip.up + 0.02 * grip.towards_camera;
    const Vector3 end = hold - (0.012 * finger) * grip.up + 0.012 * grip.towards_camera;
    body.parts.push_back({knuckle, end, 0.008, signal.skin});
  }
  const Vector3 elbow = palm + 0.16 * side - 0.2 * grip.up + 0.08 * grip.towards_camera;
  body.parts.push_back({palm, elbow, 0.034, signal.skin});
  return body;
}

void align_to_stated_frame(const Vector3& stated_m, const Quaternion& turn, ToolBody& body) {
  const Pose T_made_stated{turn, body.tool.tip_m - turn * stated_m};
  const Pose T_stated_made = T_made_stated.inverse();
  body.tool.tip_m = stated_m;
  for (int i = 0; i < body.tool.marker_count; ++i) {
    Vector3& marker = body.tool.markers_m[static_cast<std::size_t>(i)];
    marker = T_stated_made * marker;
  }
  for (Capsule& part : body.parts) {
    part.a = T_stated_made * part.a;
    part.b = T_stated_made * part.b;
  }
  body.disc_normal = T_stated_made.rotation * body.disc_normal;
  body.motion = attached_motion(body.motion, fixed_motion(T_made_stated));
}

}  // namespace glint::sim
