#include "nodes/follow_motion.hpp"

#include "kernels/pose/lever_arm.hpp"

namespace glint {
namespace {

// The frame at the middle of the tool's markers, in the base, with its covariance about the base's
// axes: there shift and rotation are measured nearly apart.
UncertainPose middle_of(const FittedTool& found, const Tool& tool, const HeadPose& head,
                        Time time) {
  const Vector3 middle = tool.middle_m();
  const Pose& seen = found.T_camera_tool;
  const Matrix6 covariance =
      moved_covariance(found.covariance, seen.rotation * (middle - tool.tip_m));
  const Pose T_camera_middle{seen.rotation, seen * middle};
  if (!head.valid) return {time, T_camera_middle, covariance};
  return {time, head.T_world_camera * T_camera_middle,
          turned_covariance(covariance, head.T_world_camera.rotation)};
}

}  // namespace

void FollowMotion::operator()(
    const FrameVerdict& verdict, const HeadPose& head, const graph::Latest<ToolSet>& tools,
    const graph::Parts<FittedTools, k_tool_slices>& fitted,
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
    if (!verdict.usable()) continue;  // a refused frame changes nothing that is known of a tool
    if (verdict.resynchronised) tool.motion.forget();
    const FittedTool& found = fitted[slice.index].tools[t];
    tool.reason = found.reason;
    if (found.reason != Reason::none) continue;
    const ReferenceFrame base = head.valid ? ReferenceFrame::world : ReferenceFrame::camera;
    if (tool.base != base) tool.motion.forget();
    tool.base = base;
    const MotionUpdate done = tool.motion.update(
        middle_of(found, set.items[t], head, verdict.stamp.mid_exposure), settings, sums_[place]);
    tool.reason = done.reason;
    if (done.reason != Reason::none) continue;
    ++counts_[2];
    counts_[3] += done.rest_tests;
    tool.estimate = tool.motion.estimate(sums_[place]);
    tool.noise = tool.motion.noise_scale();
  }
  for (; place < k_tools_per_slice; ++place) followed.items[place] = {};
}

}  // namespace glint
