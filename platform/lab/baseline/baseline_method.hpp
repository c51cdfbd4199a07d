// Baseline in place of Glint's tracker: the same frames, the same output at a constant rate. Tracks
// one tool, the first of the cell.
#pragma once

#include "nodes/check_frame.hpp"
#include "nodes/node_limits.hpp"
#include "nodes/track_tools.hpp"
#include "platform/cells/cell.hpp"
#include "platform/lab/baseline/baseline_tracker.hpp"
#include "platform/runtime/session/frame_group.hpp"

namespace glint {

class BaselineMethod final : public FrameMethod {
 public:
  explicit BaselineMethod(const Cell& cell);

  // Not for real time: OpenCV allocates.
  [[nodiscard]] const Estimates& process(const ArrivedFrame& arrived) override;

 private:
  BaselineTracker tracker_;
  CheckFrame check_;
  TrackTools track_;
  graph::Latest<ToolSet> tools_;
  graph::Parts<FittedTools, k_tool_partitions> fitted_;
  Anchor anchor_;  // without a reference body, as published
  graph::Parts<FollowedTools, k_tool_partitions> followed_;
  Estimates last_, estimates_;
};

}  // namespace glint
