#include "platform/budget/inputs/views.hpp"

#include "kernels/motion/interpolate.hpp"

namespace glint::inputs {

Tool any_tool(Numbers& numbers, int markers) {
  for (;;) {
    Tool tool;
    tool.marker_radius_m = 0.0055;
    tool.tip_m = {0, 0, -0.12};
    tool.depth_bias = {0, 0, 0, 0.1, 2};  // its own table: costs time, changes nothing
    tool.marker_count = markers;
    for (int i = 0; i < markers; ++i) tool.markers_m[i] = numbers.in_box(0.16);
    bool apart = prepare_tool(tool) == Reason::none;
    for (int i = 0; i < markers; ++i) {
      for (int j = 0; j < i; ++j) apart = apart && tool.distance_m[i][j] > 0.03;
    }
    if (apart) return tool;
  }
}

Pose any_view(Numbers& numbers) {
  const Quaternion rotation = numbers.rotation();
  return {rotation, Vector3(0, 0, 0.55) + numbers.in_box(0.4)};
}

void add_marker(Markers& markers, const Vector3& centre, const Tool& tool, int at_most) {
  if (markers.count >= at_most) return;
  Marker& marker = markers.items[markers.count++];
  marker = {};
  marker.ray = centre.normalized();
  marker.surface_range_m = centre.norm() - tool.centre_offset_m();
  marker.peak = 800;  // as from an image, so that the tool's depth bias is applied
}

void add_tool(Markers& markers, const Tool& tool, const Pose& pose, double sigma_m,
              Numbers& numbers, int at_most) {
  for (int i = 0; i < tool.marker_count; ++i) {
    const Vector3 point = pose * tool.markers_m[i];
    const Vector3 noise = point.normalized() * (sigma_m * numbers.normal());
    add_marker(markers, point + noise, tool, at_most);
  }
}

Pose displaced(const Pose& from, Numbers& numbers) {
  const Vector3 turn = numbers.in_box(0.1);
  return {(from_rotation_vector(turn) * from.rotation).normalized(),
          from.translation + numbers.in_box(0.04)};
}

FrameVerdict accepted_verdict(std::uint64_t sequence) {
  FrameVerdict verdict;
  verdict.stamp.mid_exposure = Time{} + milliseconds(22) * (sequence + 1);
  verdict.stamp.arrival = verdict.stamp.mid_exposure + milliseconds(9);
  verdict.stamp.sequence = sequence;
  verdict.accepted = sequence + 1;
  return verdict;
}

}  // namespace glint::inputs
