// Choice among a tool's pose hypotheses by likelihood, and the odds of it against all others
// (sequential probability ratio test).
//
// What:     a pose hypothesis is a labeling and one minimum of its fit. The chosen one has the
//           least sum of chi-square (against the noise) and squared Mahalanobis distance (from the
//           predicted motion). The motion may itself follow a wrong hypothesis: the distance counts
//           at most by the odds that earlier frames gave the motion. Evidence accumulates, and
//           outweighs a wrong motion.
// Cost:     a few operations per pair of hypotheses.
// Worst:    all hypotheses exist.
// Accuracy: that of the likelihoods: a motion model with too small a covariance overrates nearby
//           hypotheses.
// Source:   the sequential test of two hypotheses: Wald 1945, Sequential tests of statistical
//           hypotheses, Annals of Mathematical Statistics 16(2), equation 3.6; the bound on the
//           evidence, so that a change is detected: Page 1954, Continuous inspection schemes,
//           Biometrika 41.
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/expected_pose.hpp"

namespace glint {

// Hypotheses whose tips and rotations differ by less are one pose: half of a gross error.
inline constexpr double k_hypotheses_apart_m = 0.010;
inline constexpr double k_hypotheses_apart_dot = 0.997888;  // of quaternions: 0.13 rad
// Upper limit on the squared Mahalanobis distance of the followed hypothesis. If it fails the
// chi-square test, a partially occluded marker may be the cause: its chi-square counts at most up
// to the test's limit.
inline constexpr double k_followed_nis_max = 40;
// Odds gained in a frame without another hypothesis. They are small: the true one may be among
// those not tested.
inline constexpr double k_no_alternative_odds = 8;

struct PoseHypothesis {
  Pose T_camera_tool;
  Matrix6 covariance = Matrix6::Zero();
  double chi_square = 0;
  double mahalanobis_square = 0;                  // squared Mahalanobis distance; 0: no prediction
  double chi_square_max = k_mahalanobis_unknown;  // limit of the chi-square test
  int labeling = 0;                               // index of its labeling
};

struct ChosenHypothesis {
  int index = 0;
  double odds = k_odds_max;  // against the likeliest hypothesis that is apart
  bool switched = false;     // the followed hypothesis is outweighed
  bool unexpected = false;   // far from the prediction, which no hypothesis of this frame is near
};

[[nodiscard]] bool are_apart(const Pose& one, const Pose& other,
                             const Vector3& tip_m) noexcept GLINT_NONBLOCKING;

// Requires at least one hypothesis. odds_before: of the prediction that the squared Mahalanobis
// distances refer to. tip_m: tool frame.
[[nodiscard]] ChosenHypothesis choose_hypothesis(std::span<const PoseHypothesis> readings,
                                                 double odds_before,
                                                 const Vector3& tip_m) noexcept GLINT_NONBLOCKING;

}  // namespace glint
