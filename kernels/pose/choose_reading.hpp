// Which reading of a tool's markers is the true one, and the odds of that against all others.
//
// What:     a reading is a labeling and one of its pose's minima. The chosen one has the least sum
//           of chi-square (against the noise) and surprise (against the followed motion). The
//           motion may itself follow a wrong reading: a surprise counts at most by the odds that
//           earlier frames gave the motion. Evidence accumulates, and a wrong motion is outweighed.
// Cost:     a few operations a pair of readings.
// Worst:    all readings exist.
// Accuracy: as the likelihoods: a motion model with too small a covariance overrates what is near.
// Source:   the sequential test of two hypotheses: Wald 1945, Sequential tests of statistical
//           hypotheses, Annals of Mathematical Statistics 16(2), equation 3.6; the bound on what
//           counts, so that a change is detected: Page 1954, Continuous inspection schemes,
//           Biometrika 41.
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/expected_pose.hpp"

namespace glint {

// Readings whose tip or rotation differ by less are one pose with an error: half of what is gross.
inline constexpr double k_readings_apart_m = 0.010;
inline constexpr double k_readings_apart_dot = 0.997888;  // of quaternions: 0.13 rad
// The reading that was followed has no more surprise than this. Where the noise does not explain
// it, a hidden part of a marker may: its chi-square counts no more than the noise explains.
inline constexpr double k_followed_surprise_most = 40;
// Where a frame shows no other reading, that speaks for the pose, but not much: the true one may be
// among those that were not looked at.
inline constexpr double k_no_rival_worth = 8;

struct PoseReading {
  Pose T_camera_tool;
  Matrix6 covariance = Matrix6::Zero();
  double chi_square = 0;
  double surprise = 0;                          // 0 where nothing was expected
  double explained_most = k_no_surprise_known;  // the largest chi-square that the noise explains
  int labeling = 0;                             // which one it is of
};

struct ChosenReading {
  int index = 0;
  double odds = k_odds_most;  // against the likeliest reading that is apart
  bool turned = false;        // the reading that was followed is outweighed
  bool unexpected = false;    // far from what was followed, of which this frame has no reading
};

[[nodiscard]] bool are_apart(const Pose& one, const Pose& other,
                             const Vector3& tip_m) noexcept GLINT_NONBLOCKING;

// One reading at least. odds_before: of the expectation that the surprises are from.
[[nodiscard]] ChosenReading choose_reading(std::span<const PoseReading> readings,
                                           double odds_before,
                                           const Vector3& tip_m) noexcept GLINT_NONBLOCKING;

}  // namespace glint
