// Choice of a tool's labeling by the chi-square of its weighted fit.
//
// What:     refine_pose.hpp fits every labeling. Of those that pass the chi-square test, the ones
//           with the most markers remain, and of these the one with the least chi-square is chosen.
//           If none passes, the first one that passes with one of its markers removed is chosen.
// Cost:     a weighted fit from two initial guesses for each labeling, 5 us for four markers.
// Worst:    all labelings have equal counts, none passes, and each is refitted without each marker.
// Accuracy: the chi-square test loses one true labeling in 10^4 (chi_square_limit.hpp).
// Source:   the likelihood of all labelings compared; test of the residuals as in refine_pose.hpp.
#pragma once

#include <array>

#include "kernels/limits.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/labeling.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/marker_sight.hpp"
#include "kernels/pose/refine_pose.hpp"
#include "kernels/pose/tool.hpp"

namespace glint {

// Element i belongs to element i of Markers.
using MarkerObservations = std::array<MarkerMeasurementModel, k_blobs_max>;

struct DecidedLabeling {
  int chosen = -1;  // index into Labelings::items, -1: none
  RefinedPose pose;
  // Chi-square of the next labeling with as many markers, minus the chosen one's; large if there is
  // none.
  double delta_chi_square = 1e9;
  RefineWork work;
  Reason reason = Reason::none;  // the labelings' own if there are none, bad_fit, out_of_range
};

// Requires that the tool and the labelings belong to the markers. The prior may be null.
// pose.rejected is an index into the labeling's visible markers, in the tool's order.
[[nodiscard]] DecidedLabeling decide_labeling(
    const Markers& markers, const MarkerObservations& sights, const Tool& tool,
    const Labelings& labelings, const PosePrior* prior,
    const RefineSettings& settings) noexcept GLINT_NONBLOCKING;

// Upper bound of decide_labeling's loop counts.
[[nodiscard]] constexpr RefineWork decide_work_max(int markers, const RefineSettings& settings) {
  RefineSettings none_rejected = settings;
  none_rejected.rejected_max = 0;
  const RefineWork one = refine_work_max(markers, none_rejected);
  const RefineWork again = refine_work_max(markers, settings);
  const bool twice = settings.rejected_max > 0;
  return {k_labelings_max * (one.fits + (twice ? again.fits : 0)),
          k_labelings_max * (one.steps + (twice ? again.steps : 0)),
          k_labelings_max * (one.marker_steps + (twice ? again.marker_steps : 0))};
}

}  // namespace glint
