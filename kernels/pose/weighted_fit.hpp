// The pose with the least chi-square near a start, from weighted markers and maybe a prior.
//
// What:     Gauss-Newton's steps on the normal equations; where one does not lower chi-square it is
//           taken back and shortened by Levenberg's term, a multiple of the matrix's diagonal.
// Cost:     the normal equations and a 6x6 Cholesky solution for each step.
// Worst:    steps_max steps: the best pose so far stands, and its chi-square tells how good it is.
// Accuracy: ended where the next step would lower chi-square by less than 1e-4: a hundredth of a
//           sigma, and that step is still taken.
// Source:   Levenberg 1944, Marquardt 1963; Nocedal and Wright 2006, section 10.3.
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/pose_prior.hpp"
#include "kernels/pose/weighted_marker.hpp"

namespace glint {

// Five are the usual number, from the rigid fit of points with 5 mm of noise along their rays.
inline constexpr int k_refine_steps_max = 12;

struct WeightedFit {
  Pose T_camera_tool;
  double chi_square = 0;                  // the prior's part included
  Matrix6 information = Matrix6::Zero();  // about the markers' mean; the lower half holds
  int steps = 0;
  Reason reason = Reason::none;  // degenerate: the markers and the prior do not fix the pose
};

// mean_m: of the markers, in the tool's frame. The prior may be null.
[[nodiscard]] WeightedFit fit_weighted(std::span<const WeightedMarker> markers,
                                       const Vector3& mean_m, const Pose& start,
                                       const PosePrior* prior,
                                       int steps_max) noexcept GLINT_NONBLOCKING;

}  // namespace glint
