// Predicts each tool into this frame and says where to look for it.
//
// A tool seen in the last frame is looked for around its prediction; as soon as one is not (never
// found, missed, gone), the whole frame is searched, which the budget covers anyway.
// Cost: k_tools_max predictions of k_markers_per_tool_max projections, k_tools_max^2 box merges.
// Worst input: all tools tracked and apart: as many ROIs as tools.
// Source: ROI from a linear and SLERP prediction: the seed, section III.
#pragma once

#include "graph/graph.hpp"
#include "kernels/image/roi.hpp"
#include "kernels/pose/camera_model.hpp"
#include "kernels/pose/head_pose.hpp"
#include "kernels/pose/tool.hpp"
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
  LocateSettings settings;
  CameraModel camera;
  void operator()(const FrameVerdict& verdict, const HeadPose& head,
                  const graph::Latest<ToolSet>& tools, const graph::Previous<Estimates>& last,
                  Predictions& predictions) const noexcept;
};

// The rectangles to search: around the priors, or the whole frame; none for a refused frame.
struct LocateRois {
  LocateSettings settings;
  CameraModel camera;
  void operator()(const FrameVerdict& verdict, const graph::Latest<ToolSet>& tools,
                  const Predictions& predictions, Rois& rois) const noexcept;
};

}  // namespace glint
