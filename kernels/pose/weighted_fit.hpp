// The pose with the least chi-square near a start, from weighted markers and maybe a prior.
//
// What:     Gauss-Newton's steps on the normal equations; where one does not lower chi-square it is
//           taken back and shortened by Levenberg's term, a multiple of the matrix's diagonal.
// Cost:     the normal equations and a 6x6 Cholesky solution for each step.
// Worst:    steps_max steps: the best pose so far stands, and its chi-square tells how good it is.
// Accuracy: ended where a step lowers chi-square by less than 1e-4, a hundredth of a sigma, or
//           where it is shorter than a tenth and the next would be as short as that: each lowers it
//           by no larger a part than the one before. The step is still taken.
// Source:   Levenberg 1944, Marquardt 1963; Nocedal and Wright 2006, section 10.3: how it converges
//           where residuals are small.
#pragma once

#include <limits>
#include <span>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/pose_prior.hpp"
#include "kernels/pose/weighted_marker.hpp"

namespace glint {

// Two or three are the usual number, from the rigid fit of points with 5 mm of noise along their
// rays.
inline constexpr int k_refine_steps_max = 12;
// After so many it shows whether a start leads anywhere near.
inline constexpr int k_steps_granted = 3;

struct WeightedFit {
  Pose T_camera_tool;
  double chi_square = 0;                  // the prior's part included
  Matrix6 information = Matrix6::Zero();  // about the markers' mean; the lower half holds
  int steps = 0;
  // degenerate: the markers and the prior do not fix the pose. bad_fit: given up.
  Reason reason = Reason::none;
};

// mean_m: of the markers, in the tool's frame. The prior may be null. Given up where chi-square
// is above `hopeless` still when k_steps_granted have been taken.
[[nodiscard]] WeightedFit fit_weighted(
    std::span<const WeightedMarker> markers, const Vector3& mean_m, const Pose& start,
    const PosePrior* prior, int steps_max,
    double hopeless = std::numeric_limits<double>::infinity()) noexcept GLINT_NONBLOCKING;

}  // namespace glint
