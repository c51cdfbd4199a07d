// Predicts each tool into this frame and says where to look for it.
//
// A tool seen in the last frame is looked for around its prediction; as soon as one is not (never
// found, missed, gone), the whole frame is searched, which the budget covers anyway.
// Cost: a prediction for each tool, a projection for each of its markers (through a lens table: up
// to lens_steps look-ups each), and (tools - 1)^2 comparisons of boxes.
// Worst input: all tools tracked, and the last one's box meets the others one after the other, each
// only once the one before has been merged.
// Source: ROI from a linear and SLERP prediction: the seed, section III.
#pragma once

#include <array>
#include <string_view>

#include "graph/graph.hpp"
#include "kernels/image/roi.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/camera_model.hpp"
#include "kernels/pose/head_pose.hpp"
#include "kernels/pose/tool.hpp"
#include "nodes/node_limits.hpp"
#include "nodes/tokens.hpp"

namespace glint {

struct LocateSettings {
  Duration lost_after = milliseconds(250);
  // Beyond this gap a constant velocity says less than the last position: the tool is held there.
  Duration horizon = milliseconds(60);
  // How far a hand can stray from a constant velocity: half its greatest acceleration times the gap
  // squared. 30 m/s^2 is a brisk jerk of the wrist (TUM-VI room1 peaks below it).
  double acceleration_max_m_s2 = 30.0;
  double margin_m = 0.015;  // prediction noise of a tool that rests
};

// Priors for every tool, from the tracks of the last frame, and the pixels of their markers.
struct PredictTracks {
  static constexpr std::array<std::string_view, 5> k_loops = {"call", "tools", "moving", "markers",
                                                              "lens_steps"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    const std::int64_t markers = std::int64_t{limits.tools} * limits.markers_per_tool;
    return {{1, limits.tools, limits.tools, markers, markers * limits.lens_steps}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  LocateSettings settings;
  CameraModel camera;
  Limits limits;
  void operator()(const FrameVerdict& verdict, const HeadPose& head,
                  const graph::Latest<ToolSet>& tools, const graph::Previous<Anchor>& anchor,
                  const graph::Previous<Estimates>& last,
                  Predictions& predictions) noexcept GLINT_NONBLOCKING;

 private:
  graph::LoopCounts counts_;
};

// The rectangles to search: around the priors, or the whole frame; none for a refused frame.
struct LocateRois {
  static constexpr std::array<std::string_view, 3> k_loops = {"call", "tools", "comparisons"};
  // Of n boxes the first n - 1 can stay apart, (n - 1)(n - 2) / 2 comparisons, and the last can
  // then be merged with each at the last of those that are left, n (n - 1) / 2 more.
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    const std::int64_t others = limits.tools - 1;
    return {{1, limits.tools, others * others}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  LocateSettings settings;
  CameraModel camera;
  Limits limits;
  void operator()(const FrameVerdict& verdict, const graph::Latest<ToolSet>& tools,
                  const Predictions& predictions, Rois& rois) noexcept GLINT_NONBLOCKING;

 private:
  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<PredictTracks, Limits> && graph::Budgeted<LocateRois, Limits>);

}  // namespace glint
