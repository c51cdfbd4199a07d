#include "nodes/follow_motion.hpp"

#include "kernels/pose/choose_hypothesis.hpp"
#include "kernels/pose/lever_arm.hpp"

namespace glint {
namespace {

MeasuredPoint in_base(const IdentifiedMarker& marker, const Tool& tool,
                      const CorrectedHead& corrected_head) {
  const Pose T_base_camera =
      corrected_head.head.valid ? corrected_head.head.T_world_camera : Pose{};
  const Matrix3 rotation = T_base_camera.rotation.toRotationMatrix();
  MeasuredPoint point;
  point.model_m = tool.markers_m[static_cast<std::size_t>(marker.of_tool)] - tool.middle_m();
  point.measured_m = T_base_camera * marker.centre_m;
  point.covariance_m2 = rotation * marker.covariance_m2 * rotation.transpose();
  if (corrected_head.head.valid)
    point.covariance_m2 += corrected_head.independent_at(point.measured_m).topLeftCorner<3, 3>();
  return point;
}

bool sigmas_within(const Matrix3& covariance, double sigma) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(covariance(axis, axis) <= sigma * sigma)) return false;
  }
  return true;
}

bool is_precise(const MotionCovariance& covariance, const PrecisionLimits& precision_limits) {
  return sigmas_within(covariance.block<3, 3>(k_position, k_position),
                       precision_limits.position_m) &&
         sigmas_within(covariance.block<3, 3>(k_rotation, k_rotation),
                       precision_limits.rotation_rad);
}

// The markers' own pose is not near the one that agrees with the motion: they allow both.
bool is_in_another_minimum(const FittedTool& found, const Tool& tool) {
  return found.has_relinearised &&
         are_apart(found.T_camera_tool, found.relinearised_T_camera_tool, tool.tip_m);
}

}  // namespace

UncertainPose in_base(const UncertainPose& T_camera_centroid,
                      const CorrectedHead& corrected_head) noexcept {
  if (!corrected_head.head.valid) return T_camera_centroid;
  const Pose& T_world_camera = corrected_head.head.T_world_camera;
  const Pose T_world_centroid = T_world_camera * T_camera_centroid.pose;
  return {T_camera_centroid.time, T_world_centroid,
          rotated_covariance(T_camera_centroid.covariance, T_world_camera.rotation) +
              corrected_head.independent_at(T_world_centroid.translation)};
}

CorrelatedErrors in_base(const CorrelatedErrors& of_camera,
                         const CorrectedHead& corrected_head) noexcept {
  if (!corrected_head.head.valid) return of_camera;
  const Quaternion& rotation = corrected_head.head.T_world_camera.rotation;
  return {rotated_covariance(of_camera.fast, rotation),
          rotated_covariance(of_camera.slow, rotation)};
}

// Updates the filter by one or two markers; leaves `reason`, which states why there is no pose.
void FollowMotion::update_partial(const PartialMarkers& partial, const Tool& shape,
                                  const CorrectedHead& corrected_head, Time time, int slot,
                                  TrackedTool& tool) noexcept {
  const ReferenceFrame base =
      corrected_head.head.valid ? ReferenceFrame::world : ReferenceFrame::camera;
  if (partial.count == 0 || tool.base != base) return;
  std::array<MeasuredPoint, k_points_max> points;
  std::uint8_t mask = 0;
  for (int i = 0; i < partial.count; ++i) {
    const IdentifiedMarker& marker = partial.items[static_cast<std::size_t>(i)];
    points[static_cast<std::size_t>(i)] = in_base(marker, shape, corrected_head);
    mask = static_cast<std::uint8_t>(mask | (1u << marker.of_tool));
  }
  const auto count = static_cast<std::size_t>(partial.count);
  if (tool.motion.update(time, {points.data(), count}, settings, sums_[slot]) != Reason::none)
    return;
  ++counts_[graph::loop_of<FollowMotion>("moved")];
  tool.partial_mask = mask;
  tool.estimate = tool.motion.estimate(sums_[slot]);
  tool.correlated_covariance = tool.motion.correlated_covariance(sums_[slot]);
  tool.noise = tool.motion.partial_visibility_noise_scale(settings);
  tool.is_publishable = is_precise(tool.estimate.covariance, precision_limits);
}

void FollowMotion::operator()(
    const FrameVerdict& verdict, const Anchor& anchor, const graph::Latest<ToolSet>& tools,
    const graph::Parts<FittedTools, k_tool_partitions>& fitted, const SeenFew& partial,
    const graph::Previous<graph::Parts<FollowedTools, k_tool_partitions>>& last,
    graph::Partition partition, FollowedTools& followed) noexcept {
  const ToolSet& set = tools.value();
  const int count = tools_within(set, limits);
  counts_ = {{1}};
  int slot = 0;
  for (int t = partition.index; t < count; t += partition.count, ++slot) {
    ++counts_[graph::loop_of<FollowMotion>("tools")];
    TrackedTool& tool = followed.items[slot];
    tool = last.value()[partition.index].items[slot];
    tool.reason = verdict.reason;
    tool.partial_mask = 0;
    tool.is_publishable = false;
    tool.ambiguous = tool.use_filter_pose = false;
    tool.in_use = true;
    if (tool.identity != set.items[t].identity) {
      tool.motion.reset();
      tool.identity = set.items[t].identity;
    }
    if (!verdict.usable()) continue;  // a rejected frame leaves the track unchanged
    if (verdict.resynchronised) tool.motion.reset();
    const CorrectedHead& corrected_head = anchor.now;
    if (tool.base == ReferenceFrame::world) {
      if (corrected_head.moved_along) tool.motion.move(corrected_head.gap_correction);
      if (corrected_head.in_gap)
        tool.motion.inflate_covariance(corrected_head.step_covariance_at(tool.motion.place()));
    }
    const FittedTool& found = fitted[partition.index].tools[t];
    tool.reason = found.reason;
    if (found.reason != Reason::none) {
      update_partial(partial.tools[t], set.items[t], corrected_head, verdict.stamp.mid_exposure,
                     slot, tool);
      continue;
    }
    const ReferenceFrame base =
        corrected_head.head.valid ? ReferenceFrame::world : ReferenceFrame::camera;
    if (tool.base != base || found.contradicts_track) tool.motion.reset();
    tool.base = base;
    const UncertainPose seen =
        filter_measurement_of(found, set.items[t], verdict.stamp.mid_exposure);
    const MotionUpdate done = tool.motion.update(
        in_base(seen, corrected_head), in_base(found.systematic.correlated, corrected_head),
        settings, sums_[slot]);
    tool.reason = done.reason;
    if (done.reason != Reason::none) continue;
    ++counts_[graph::loop_of<FollowMotion>("moved")];
    counts_[graph::loop_of<FollowMotion>("rest_tests")] += done.static_tests;
    tool.estimate = tool.motion.estimate(sums_[slot]);
    tool.correlated_covariance = tool.motion.correlated_covariance(sums_[slot]);
    tool.noise = tool.motion.noise_scale();
    tool.ambiguous = found.ambiguous();
    tool.use_filter_pose =
        is_in_another_minimum(found, set.items[t]) ||
        !sigmas_within(found.covariance.bottomRightCorner<3, 3>(), precision_limits.rotation_rad);
    tool.is_publishable = !tool.ambiguous && is_precise(tool.estimate.covariance, precision_limits);
  }
  // Clear used entries only: clearing all would cost more than tracking a tool.
  for (; slot < k_tools_per_partition; ++slot) {
    if (followed.items[slot].in_use) followed.items[slot] = {};
  }
}

}  // namespace glint
