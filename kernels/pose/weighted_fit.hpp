// Weighted pose fit of a tool's labelled markers by Gauss-Newton with Levenberg-Marquardt damping,
// with an optional prior.
//
// What:     Gauss-Newton steps on the normal equations. A step that does not lower chi-square is
//           undone and shortened by Levenberg's term, a multiple of the matrix's diagonal.
// Cost:     the normal equations and a 6x6 Cholesky solution for each step.
// Worst:    steps_max steps: the best pose so far is returned, and its chi-square shows its
//           quality.
// Accuracy: ends when a step lowers chi-square by less than 1e-4, a hundredth of a sigma. It also
//           ends when a step is shorter than a tenth of a sigma and the next one would lower
//           chi-square by less than 1e-4. The ratio of successive decreases, which does not grow,
//           predicts that. The last step is still taken.
// Source:   Levenberg 1944, Marquardt 1963; Nocedal and Wright 2006, section 10.3: convergence for
//           small residuals.
#pragma once

#include <limits>
#include <span>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/pose_prior.hpp"
#include "kernels/pose/weighted_marker.hpp"

namespace glint {

// Usually two or three, from the rigid fit of points with 5 mm of noise along their rays.
inline constexpr int k_refine_steps_max = 12;
// Number of steps after which the `chi_square_stop` limit is tested.
inline constexpr int k_steps_before_limit = 3;

struct WeightedFit {
  Pose T_camera_tool;
  double chi_square = 0;                  // including the prior's part
  Matrix6 information = Matrix6::Zero();  // about the markers' mean; lower triangle only
  int steps = 0;
  // degenerate: the markers and the prior do not determine the pose. bad_fit: above
  // `chi_square_stop`.
  Reason reason = Reason::none;
};

// mean_m: of the markers, tool frame. The prior may be null. Ends with bad_fit if chi-square is
// still above `chi_square_stop` after k_steps_before_limit steps.
[[nodiscard]] WeightedFit fit_weighted(
    std::span<const WeightedMarker> markers, const Vector3& mean_m, const Pose& start,
    const PosePrior* prior, int steps_max,
    double chi_square_stop = std::numeric_limits<double>::infinity()) noexcept GLINT_NONBLOCKING;

}  // namespace glint
