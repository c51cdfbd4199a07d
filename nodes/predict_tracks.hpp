// Predicts each tool's pose into this frame, with a search radius (reach).
//
// What:   extrapolates the filtered motion to this frame's mid-exposure, mean and covariance in
//         closed form (kernels/motion/predict_motion.hpp). Transforms it from the world to the
//         camera and adds the change of the headset's error since then. The reach is k_reach_sigmas
//         of the most uncertain marker, larger after a measurement with a large NIS. Its lower
//         bound is the start of motion of a static hand, its upper bound the fastest hand motion.
// Cost:   one prediction per tool; one covariance and one projection per marker (through a lens
//         table: up to lens_steps look-ups).
// Worst:  all tools tracked, with a valid head pose; independent of the covariances.
// Source: an Ornstein-Uhlenbeck process changes by a variance of 2 (1 - exp(-t / tau)) of its own
//         in the time t (1930); no eigenvalue exceeds the largest row sum (Gershgorin 1931).
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

// The gate only limits cost; the residual test decides. It is so wide that noise never reaches it.
inline constexpr double k_reach_sigmas = 8;

struct ReachSettings {
  Duration lost_after = milliseconds(250);
  // Prediction horizon: beyond it the last position is better than extrapolation; the tool stays
  // there.
  Duration horizon = milliseconds(60);
  MotionSettings motion;            // as used by the motion filter
  double head_correlation_s = 0.4;  // of the headset's localisation error while it moves
  // Three sigma of a marker's range error.
  double reach_min_m = 0.0045;
  // A static hand may start to move: half of this acceleration times the gap squared. 30 m/s^2 is a
  // brisk wrist movement (TUM-VI room1 peaks below it). The time is bounded by start_max: a longer
  // motion is visible to the filter.
  double acceleration_max_m_s2 = 30.0;
  Duration start_max = milliseconds(60);
  // Up to this standard deviation a speed counts as estimated; the initial one is larger. A
  // tool detected once may be faster than any hand: it is searched in the whole frame until it is
  // detected again.
  double speed_sigma_max_m_s = 0.25;
  // Upper bound of the reach, whatever the covariance: no hand is faster or farther than this.
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
  struct PredictedMotion {
    double hold_distance_m = 0;  // distance from the extrapolated to the held position
    double head_sigma_m = 0;     // of the tool's position by the headset's error, an axis
  };
  PredictedMotion predict_track(const Track& track, const Tool& tool, Time time,
                                const HeadDriftCorrection& anchor, const Pose* T_camera_world,
                                Prediction& prediction) noexcept GLINT_NONBLOCKING;
  [[nodiscard]] double reach_of(
      const Prediction& prediction, const Tool& tool, int markers, double seconds,
      const PredictedMotion& predicted_motion) const noexcept GLINT_NONBLOCKING;

  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<PredictTracks, Limits>);

}  // namespace glint
