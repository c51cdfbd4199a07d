#include "nodes/follow_motion.hpp"

#include "kernels/pose/lever_arm.hpp"

namespace glint {
namespace {

UncertainPose in_base(const UncertainPose& T_camera_middle, const AnchoredHead& anchored) {
  if (!anchored.head.valid) return T_camera_middle;
  const Pose& T_world_camera = anchored.head.T_world_camera;
  const Pose T_world_middle = T_world_camera * T_camera_middle.pose;
  return {T_camera_middle.time, T_world_middle,
          turned_covariance(T_camera_middle.covariance, T_world_camera.rotation) +
              anchored.fresh_at(T_world_middle.translation)};
}

CorrelatedErrors in_base(const CorrelatedErrors& of_camera, const AnchoredHead& anchored) {
  if (!anchored.head.valid) return of_camera;
  const Quaternion& turn = anchored.head.T_world_camera.rotation;
  return {turned_covariance(of_camera.fast, turn), turned_covariance(of_camera.slow, turn)};
}

MeasuredPoint in_base(const NamedMarker& marker, const Tool& tool, const AnchoredHead& anchored) {
  const Pose T_base_camera = anchored.head.valid ? anchored.head.T_world_camera : Pose{};
  const Matrix3 turn = T_base_camera.rotation.toRotationMatrix();
  MeasuredPoint point;
  point.model_m = tool.markers_m[static_cast<std::size_t>(marker.of_tool)] - tool.middle_m();
  point.measured_m = T_base_camera * marker.centre_m;
  point.covariance_m2 = turn * marker.covariance_m2 * turn.transpose();
  if (anchored.head.valid)
    point.covariance_m2 += anchored.fresh_at(point.measured_m).topLeftCorner<3, 3>();
  return point;
}

bool within(const Matrix3& covariance, double sigma) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(covariance(axis, axis) <= sigma * sigma)) return false;
  }
  return true;
}

bool is_sure(const MotionCovariance& covariance, const SureLimits& sure) {
  return within(covariance.block<3, 3>(k_position, k_position), sure.position_m) &&
         within(covariance.block<3, 3>(k_rotation, k_rotation), sure.rotation_rad);
}

}  // namespace

// Updates the filter by one or two markers; leaves `reason`, which states why there is no pose.
void FollowMotion::follow_few(const FewMarkers& few, const Tool& shape,
                              const AnchoredHead& anchored, Time time, int place,
                              FollowedTool& tool) noexcept {
  const ReferenceFrame base = anchored.head.valid ? ReferenceFrame::world : ReferenceFrame::camera;
  if (few.count == 0 || tool.base != base) return;
  std::array<MeasuredPoint, k_points_max> points;
  std::uint8_t mask = 0;
  for (int i = 0; i < few.count; ++i) {
    const NamedMarker& marker = few.items[static_cast<std::size_t>(i)];
    points[static_cast<std::size_t>(i)] = in_base(marker, shape, anchored);
    mask = static_cast<std::uint8_t>(mask | (1u << marker.of_tool));
  }
  const auto count = static_cast<std::size_t>(few.count);
  if (tool.motion.update(time, {points.data(), count}, settings, sums_[place]) != Reason::none)
    return;
  ++counts_[2];
  tool.few_mask = mask;
  tool.estimate = tool.motion.estimate(sums_[place]);
  tool.correlated_covariance = tool.motion.correlated_covariance(sums_[place]);
  tool.noise = tool.motion.partial_noise_scale(settings);
  tool.stands = is_sure(tool.estimate.covariance, sure);
}

void FollowMotion::operator()(
    const FrameVerdict& verdict, const Anchor& anchor, const graph::Latest<ToolSet>& tools,
    const graph::Parts<FittedTools, k_tool_slices>& fitted, const SeenFew& few,
    const graph::Previous<graph::Parts<FollowedTools, k_tool_slices>>& last, graph::Slice slice,
    FollowedTools& followed) noexcept {
  const ToolSet& set = tools.value();
  const int count = tools_within(set, limits);
  counts_ = {{1}};
  int place = 0;
  for (int t = slice.index; t < count; t += slice.count, ++place) {
    ++counts_[1];
    FollowedTool& tool = followed.items[place];
    tool = last.value()[slice.index].items[place];
    tool.reason = verdict.reason;
    tool.few_mask = 0;
    tool.stands = false;
    tool.ambiguous = tool.filtered = false;
    tool.in_use = true;
    if (tool.identity != set.items[t].identity) {
      tool.motion.forget();
      tool.identity = set.items[t].identity;
    }
    if (!verdict.usable()) continue;  // a rejected frame leaves the track unchanged
    if (verdict.resynchronised) tool.motion.forget();
    const AnchoredHead& anchored = anchor.now;
    if (tool.base == ReferenceFrame::world) {
      if (anchored.moved_along) tool.motion.move(anchored.moved);
      if (anchored.in_gap) tool.motion.loosen(anchored.stepped_at(tool.motion.place()));
    }
    const FittedTool& found = fitted[slice.index].tools[t];
    tool.reason = found.reason;
    if (found.reason != Reason::none) {
      follow_few(few.tools[t], set.items[t], anchored, verdict.stamp.mid_exposure, place, tool);
      continue;
    }
    const ReferenceFrame base =
        anchored.head.valid ? ReferenceFrame::world : ReferenceFrame::camera;
    if (tool.base != base || found.turned) tool.motion.forget();
    tool.base = base;
    const UncertainPose seen = told_middle_of(found, set.items[t], verdict.stamp.mid_exposure);
    const MotionUpdate done =
        tool.motion.update(in_base(seen, anchored), in_base(found.systematic.correlated, anchored),
                           settings, sums_[place]);
    tool.reason = done.reason;
    if (done.reason != Reason::none) continue;
    ++counts_[2];
    counts_[3] += done.rest_tests;
    tool.estimate = tool.motion.estimate(sums_[place]);
    tool.correlated_covariance = tool.motion.correlated_covariance(sums_[place]);
    tool.noise = tool.motion.noise_scale();
    tool.ambiguous = found.ambiguous();
    tool.filtered = !within(found.covariance.bottomRightCorner<3, 3>(), sure.rotation_rad);
    tool.stands = !tool.ambiguous && is_sure(tool.estimate.covariance, sure);
  }
  // Clear used entries only: clearing all would cost more than tracking a tool.
  for (; place < k_tools_per_slice; ++place) {
    if (followed.items[place].in_use) followed.items[place] = {};
  }
}

}  // namespace glint
