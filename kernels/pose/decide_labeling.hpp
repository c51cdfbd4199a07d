// Which of a tool's labelings is its own: the one that the noise explains best.
//
// What:     every labeling kept is fitted by refine_pose.hpp; of those whose chi-square the noise
//           explains the ones with the most markers stand, and of these the least chi-square. Where
//           none is explained, the first one that is without one of its markers.
// Cost:     a weighted fit from two starts for each labeling, 5 us of four markers.
// Worst:    all labelings alike in count, none explained, each refitted without each marker.
// Accuracy: chi-square loses one true labeling in 10^4 (chi_square_limit.hpp).
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

// Each beside the marker with the same index in Markers.
using MarkerSights = std::array<MarkerSight, k_blobs_max>;

struct DecidedLabeling {
  int chosen = -1;  // index into Labelings::items, -1: none
  RefinedPose pose;
  // How much worse the next labeling with as many markers fits; large where there is none.
  double delta_chi_square = 1e9;
  RefineWork work;
  Reason reason = Reason::none;  // the labelings' own where there are none, bad_fit, out_of_range
};

// The tool and the labelings must belong to the markers. The prior may be null. left_out in the
// pose counts the labeling's seen markers, in the tool's order.
[[nodiscard]] DecidedLabeling decide_labeling(
    const Markers& markers, const MarkerSights& sights, const Tool& tool,
    const Labelings& labelings, const PosePrior* prior,
    const RefineSettings& settings) noexcept GLINT_NONBLOCKING;

// What decide_labeling may do at most.
[[nodiscard]] constexpr RefineWork decide_work_max(int markers, const RefineSettings& settings) {
  RefineSettings none_left_out = settings;
  none_left_out.left_out_max = 0;
  const RefineWork one = refine_work_max(markers, none_left_out);
  const RefineWork again = refine_work_max(markers, settings);
  const bool twice = settings.left_out_max > 0;
  return {k_labelings_max * (one.fits + (twice ? again.fits : 0)),
          k_labelings_max * (one.steps + (twice ? again.steps : 0)),
          k_labelings_max * (one.marker_steps + (twice ? again.marker_steps : 0))};
}

}  // namespace glint
