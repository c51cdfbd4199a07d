// Maximum-likelihood pose of a tool from its labelled markers, each weighted by its own noise, with
// covariance and rejection of one outlier.
//
// What:     minimises chi-square over the pixels' and ranges' own noise. A flat tool has two
//           minima, so the initial guesses are the rigid fit and its depth flip, and the lesser
//           minimum is returned. If it fails the chi-square test, each marker is removed in turn,
//           and the best such fit that passes is returned. With a predicted pose, the best is the
//           one with the least sum of chi-square and squared Mahalanobis distance
//           (expected_pose.hpp). This separates a flat tool's minima where the noise alone does
//           not. The pose itself depends on the markers alone: a filter that predicted it would
//           otherwise count the prediction twice.
// Cost:     two weighted fits of two to four steps (bench_tracker); with one of n markers removed 2
//           n more, of at most half as many steps.
// Worst:    5 or more markers that fail the test, together and without any one: 2 (n + 1) fits with
//           the maximum number of steps.
// Accuracy: reaches the Cramer-Rao bound if the tool is tilted by 20 degrees or more (glint
//           experiment bound); below, where the two minima merge, within some 15 %.
// Source:   Foerstner and Wrobel 2016, Photogrammetric Computer Vision, section 4.4 (the weighted
//           fit, its covariance and the test of its residuals); two minima of a flat target:
//           Schweighofer and Pinz 2006.
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/limits.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/expected_pose.hpp"
#include "kernels/pose/pose_prior.hpp"
#include "kernels/pose/weighted_fit.hpp"
#include "kernels/pose/weighted_marker.hpp"
#include "kernels/reason.hpp"

namespace glint {

struct RefineSettings {
  int steps_max = k_refine_steps_max;  // of each fit of all markers
  int rejected_max = 1;                // 0: no marker is removed, an outlier corrupts the pose
  // Of each fit with one marker removed: there may be many, and a fit that will pass is nearly
  // converged by then.
  int rejection_steps_max = k_refine_steps_max / 2;
  // Minimum number of markers after a removal. Three agree by chance too easily: set 3 only if all
  // are at their predicted positions.
  int markers_kept_min = 4;
};

// Two minima closer to each other than this squared Mahalanobis distance are one.
inline constexpr double k_minima_apart_min = 0.01;
// Limit on chi-square of a fit from the flip after k_steps_before_limit steps, as excess over a
// first fit that passes the test. It applies to four or more markers. Above it the flip leads to no
// second minimum: the fit would converge slowly to the first one, or to one that is as bad. With
// three markers a late second minimum was observed.
inline constexpr double k_flip_excess_max = 1000;

// Loop counts.
struct RefineWork {
  int fits = 0;
  int steps = 0;         // of all fits
  int marker_steps = 0;  // steps times the markers in them
  constexpr RefineWork& operator+=(const RefineWork& more) {
    fits += more.fits;
    steps += more.steps;
    marker_steps += more.marker_steps;
    return *this;
  }
};
[[nodiscard]] constexpr RefineWork refine_work_max(int markers, const RefineSettings& settings) {
  const int others = settings.rejected_max > 0 && markers > settings.markers_kept_min ? markers : 0;
  const int all = 2 * settings.steps_max, each = 2 * settings.rejection_steps_max;
  return {2 * (1 + others), all + each * others, all * markers + each * others * (markers - 1)};
}

// Second minimum: the pose in which the markers look nearly as they do in the best one.
struct OtherMinimum {
  bool exists = false;
  Pose T_camera_tool;
  Matrix6 covariance = Matrix6::Zero();  // as the best pose's
  double delta_chi_square = 0;           // excess over the best one's; 9: three sigma
  double mahalanobis_square = 0;
};

struct RefinedPose {
  Pose T_camera_tool;
  Matrix6 covariance = Matrix6::Zero();  // of the reference; order as in fit_covariance.hpp
  double chi_square = 0;
  double mahalanobis_square = 0;  // squared Mahalanobis distance from the prediction, or 0
  int degrees_of_freedom = 0;     // residuals, plus the prior's six, minus the pose's six
  OtherMinimum other;
  // A flat tool seen nearly face-on: its two minima merge, or are nearly equally likely. The
  // covariance of each is smaller than the markers' information justifies.
  bool shallow = false;
  int rejected = -1;  // index of the removed marker, -1: none
  RefineWork work;
  Reason reason = Reason::none;
};

// reference_m: the tool's point (the tip), tool frame, to which the covariance refers. The prior
// may be null; with one a single marker is enough, without one three that are not on a line.
// `expected` may be null, too; it only selects the minimum. Reason: too_few_markers (or more than
// k_markers_per_tool_max), degenerate, collinear, out_of_range; or bad_fit if the fit fails the
// chi-square test. Then the pose is set, with rejected -1, but must not be used as a measurement.
[[nodiscard]] RefinedPose refine_pose(
    std::span<const WeightedMarker> markers, const Vector3& reference_m,
    const PosePrior* prior = nullptr, const RefineSettings& settings = {},
    const PredictedPose* expected = nullptr) noexcept GLINT_NONBLOCKING;

}  // namespace glint
