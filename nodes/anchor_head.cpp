#include "nodes/anchor_head.hpp"

#include "kernels/pose/lever_arm.hpp"

namespace glint {

void AnchorHead::operator()(const FrameVerdict& verdict, const HeadPose& head,
                            const graph::Latest<ToolSet>& tools,
                            const graph::Parts<FittedTools, k_tool_partitions>& fitted,
                            const graph::Previous<Anchor>& last, Anchor& anchor) noexcept {
  counts_ = {{1}};
  anchor = last.value();
  anchor.now = CorrectedHead{};
  if (!verdict.usable()) return;
  if (verdict.resynchronised) anchor.state.restart_clock();
  const bool declared = reference >= 0 && reference < tools_within(tools.value(), limits);
  const std::uint32_t body_now = declared ? tools.value().items[reference].identity : 0;
  if (anchor.body != body_now)
    anchor.state = HeadDriftCorrection{};  // another body has another pose
  anchor.body = body_now;
  UncertainPose body;
  const UncertainPose* detected = nullptr;
  if (declared) {
    const FittedTool& found = fitted[reference % k_tool_partitions].tools[reference];
    if (found.reason == Reason::none && !found.ambiguous()) {
      body = centroid_pose_of(found, tools.value().items[reference], verdict.stamp.mid_exposure);
      detected = &body;
      ++counts_[graph::loop_of<AnchorHead>("sights")];
    }
  }
  anchor.now = anchor.state.update(head, detected, noise);
  if (!declared) return;
  const Pose to_tool{Quaternion::Identity(), -tools.value().items[reference].middle_m()};
  anchor.T_world_reference = anchor.state.T_world_body() * to_tool;
}

}  // namespace glint
