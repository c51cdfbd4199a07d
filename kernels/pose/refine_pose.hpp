// The most likely pose of a tool from its labelled markers, each as sure as it is, and how sure the
// pose is.
//
// What:     chi-square over the pixels' and ranges' own noise made least, from the rigid fit and
//           from its depth flip (a flat tool has two minima); the lesser of both stands. Where
//           the noise does not explain it, each marker is left out in turn, and the best such fit
//           that the noise does explain stands. Where a pose is expected, the best is the one with
//           the least sum of chi-square and surprise (expected_pose.hpp): so a flat tool's minima
//           are told apart where the noise alone does not. The pose itself rests on the markers
//           alone: a filter that foretold it would else count it twice.
// Cost:     two weighted fits of two to four steps (bench_tracker); without one of n markers 2 n
//           more, of half as many steps as they may take at most.
// Worst:    5 or more markers that no pose explains, nor any without one: 2 (n + 1) fits of all
//           the steps they may take.
// Accuracy: reaches the Cramer-Rao bound where the tool is tilted by 20 degrees or more (glint
//           experiment bound); below, where both minima run into each other, within some 15 %.
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
  int left_out_max = 1;                // 0: no marker is left out, a bad one spoils the pose
  // Of each fit without one marker: of these there may be many, and one that is to stand is near
  // its end by then.
  int left_out_steps_max = k_refine_steps_max / 2;
  // So many markers are left when one was left out. Three agree too easily, unless all lie where
  // they were predicted: then 3.
  int markers_left_least = 4;
};

// Two minima nearer to each other than this, in sigmas squared, are one.
inline constexpr double k_minima_apart_least = 0.01;
// A flip of four or more markers whose chi-square lies so far above that of a first fit which the
// noise explains, after k_steps_granted, is a second minimum no more: it goes the long way round to
// the first one, or to one that is as bad. Of three markers a late second minimum was seen.
inline constexpr double k_flip_hopeless = 1000;

// The loops, as a node counts them.
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
  const int others =
      settings.left_out_max > 0 && markers > settings.markers_left_least ? markers : 0;
  const int all = 2 * settings.steps_max, each = 2 * settings.left_out_steps_max;
  return {2 * (1 + others), all + each * others, all * markers + each * others * (markers - 1)};
}

// The pose in which the markers look nearly as they do in the best one.
struct OtherMinimum {
  bool exists = false;
  Pose T_camera_tool;
  Matrix6 covariance = Matrix6::Zero();  // as the best one's
  double delta_chi_square = 0;           // by how much it is worse; 9: three sigmas
  double surprise = 0;
};

struct RefinedPose {
  Pose T_camera_tool;
  Matrix6 covariance = Matrix6::Zero();  // of the reference; order as in fit_covariance.hpp
  double chi_square = 0;
  double surprise = 0;         // to whom expected a pose; 0 where none was
  int degrees_of_freedom = 0;  // residuals, the prior's six too, less the pose's six
  OtherMinimum other;
  // A flat tool seen nearly face-on: its two minima run into each other, or are nearly as likely.
  // Each is surer of itself than the markers are.
  bool shallow = false;
  int left_out = -1;  // index of the marker that did not fit, -1: all count
  RefineWork work;
  Reason reason = Reason::none;
};

// reference_m: the point of the tool, in its frame, whose place is asked for (the tip). The prior
// may be null; with one a single marker is enough, without one three that are not on a line. What
// is expected may be null, too; it only helps to choose.
// Reason: too_few_markers (or more than k_markers_per_tool_max), degenerate, collinear,
// out_of_range; or bad_fit: the noise does not explain what is left. Then the pose stands, with
// left_out -1, but must not be called measured.
[[nodiscard]] RefinedPose refine_pose(
    std::span<const WeightedMarker> markers, const Vector3& reference_m,
    const PosePrior* prior = nullptr, const RefineSettings& settings = {},
    const ExpectedPose* expected = nullptr) noexcept GLINT_NONBLOCKING;

}  // namespace glint
