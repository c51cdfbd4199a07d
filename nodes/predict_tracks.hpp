// Predicts each tool into this frame, and how far it may be from there.
//
// What:   the motion that the filter followed goes on to this frame's mid-exposure, mean and
//         covariance in closed form (kernels/motion/predict_motion.hpp), and from the world into
//         the camera, with what the headset's own error may have changed by since. The reach is
//         k_reach_sigmas of the marker that is least sure, more after a measurement that was less
//         like the foretold one than its covariance said; between what a hand at rest may set off
//         by unforeseen and what any hand can do.
// Cost:   a prediction for each tool; for each of its markers a covariance and a projection
//         (through a lens table: up to lens_steps look-ups).
// Worst:  all tools tracked, with the head's pose known. How sure a track is makes no difference.
// Source: an Ornstein and Uhlenbeck walk moves by a variance of 2 (1 - exp(-t / tau)) of its own
//         in the time t (1930); no eigenvalue is larger than the largest row sum (Gershgorin 1931).
#pragma once

#include <array>
#include <string_view>

#include "graph/graph.hpp"
#include "kernels/motion/motion_filter.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/camera_model.hpp"
#include "kernels/pose/head_pose.hpp"
#include "kernels/pose/tool.hpp"
#include "nodes/node_limits.hpp"
#include "nodes/tokens.hpp"

namespace glint {

// The gate only limits cost, the residual decides: wide enough that noise never reaches it.
inline constexpr double k_reach_sigmas = 8;

struct ReachSettings {
  Duration lost_after = milliseconds(250);
  // Beyond it speeds and accelerations say less than the last place: the tool is held there.
  Duration horizon = milliseconds(60);
  MotionSettings motion;            // as those that the tracks were followed with
  double head_correlation_s = 0.4;  // of the headset's own error while it moves
  // Three sigma of a marker's range, by which what is seen of it may lie beside it.
  double floor_m = 0.0045;
  // A hand that rests, and is known to, may set off: half its greatest acceleration times the gap
  // squared. 30 m/s^2 is a brisk jerk of the wrist (TUM-VI room1 peaks below it). Not longer than
  // start_max: one that has moved on for longer is seen to move.
  double acceleration_max_m_s2 = 30.0;
  Duration start_max = milliseconds(60);
  // A speed this sure was seen; before that a hand's is taken to be twice as unsure. A tool found
  // once may go faster than any hand: it is looked for everywhere until it is found again.
  double known_speed_m_s = 0.25;
  // However unsure a track is, a hand is no faster and no further than this.
  double margin_m = 0.015;
  double speed_max_m_s = 1.0;
};

struct PredictTracks {
  static constexpr std::array<std::string_view, 5> k_loops = {"call", "tools", "moving", "markers",
                                                              "lens_steps"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    const std::int64_t markers = std::int64_t{limits.tools} * limits.markers_per_tool;
    return {{1, limits.tools, limits.tools, markers, markers * limits.lens_steps}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  ReachSettings settings;
  CameraModel camera;
  Limits limits;
  void operator()(const FrameVerdict& verdict, const HeadPose& head,
                  const graph::Latest<ToolSet>& tools, const graph::Previous<Anchor>& anchor,
                  const graph::Previous<Estimates>& last,
                  Predictions& predictions) noexcept GLINT_NONBLOCKING;

 private:
  struct Foretold {
    double held_back_m = 0;   // from where its motion would lead the tool
    double head_sigma_m = 0;  // of the tool's place by the headset's error, an axis
  };
  Foretold foretell(const Track& track, const Tool& tool, Time time, const HeadAnchor& anchor,
                    const Pose* T_camera_world, Prediction& prediction) noexcept GLINT_NONBLOCKING;
  [[nodiscard]] double reach_of(const Prediction& prediction, const Tool& tool, int markers,
                                double seconds,
                                const Foretold& foretold) const noexcept GLINT_NONBLOCKING;

  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<PredictTracks, Limits>);

}  // namespace glint
