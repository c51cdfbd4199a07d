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

}  // namespace

void FollowMotion::operator()(
    const FrameVerdict& verdict, const Anchor& anchor, const graph::Latest<ToolSet>& tools,
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
    const AnchoredHead& anchored = anchor.now;
    if (anchored.moved_along && tool.base == ReferenceFrame::world)
      tool.motion.move(anchored.moved);
    const FittedTool& found = fitted[slice.index].tools[t];
    tool.reason = found.reason;
    if (found.reason != Reason::none) continue;
    const ReferenceFrame base =
        anchored.head.valid ? ReferenceFrame::world : ReferenceFrame::camera;
    if (tool.base != base) tool.motion.forget();
    tool.base = base;
    const UncertainPose seen = middle_of(found, set.items[t], verdict.stamp.mid_exposure);
    const MotionUpdate done = tool.motion.update(in_base(seen, anchored), settings, sums_[place]);
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
