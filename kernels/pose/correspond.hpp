// Which candidate markers are which of a tool's.
//
// What:     all ways to name 3 or more of N candidates as the tool's markers whose distances agree
//           pairwise (candidates.hpp), most markers first; of those the k_labelings_max best by the
//           rigid fit's rms. The least rms over all of them decides, not the first that fits: a
//           nearly symmetric tool has several.
// Cost:     one distance table, then at most hypotheses_max partial assignments of 20 ns and
// fits_max
//           fits of 0.9 us. 5 markers and 5 strays: 3 us.
// Worst:    256 candidates as dense as the tool: the budget ends the search, Reason::search_full;
// the
//           best so far are kept, and what lies near the prediction was tried first. Uses 260 KB of
//           stack.
// Accuracy: complete within the budget. With the default gate of 6 sigma a true labeling is lost
// once
//           in 10^4 frames (correspond_test.cpp prints the figure).
// Source:   distance matrix comparison as the seed's; growth by intersecting compatible sets is
//           clique search in the association graph (Bron and Kerbosch 1973), bounded in depth.
//
// With a prediction (the prior):
//   1. First only candidates within prior_gate_m of their predicted places are tried; there, and
//      only there, min_markers_with_prior are enough.
//   2. Then all candidates are, for labelings of at least min_markers_without_prior markers and no
//      fewer than the best found.
//   3. The order stays by count, then rms, then the smaller marker indices; but among labelings
//   with
//      the most markers whose rms the noise cannot tell from the least, count (rms^2 - least^2) <=
//      9 range_sigma^2 (3 sigma of the likelihood ratio), one with every marker within the prior
//      gate stands before one without: of two mirror-like readings the predicted one is taken.
#pragma once

#include "kernels/pose/labeling.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/tool.hpp"

namespace glint {

struct CorrespondSettings {
  double focal_px = 0;     // for the area gate and the noise across the ray; 0: no area gate,
                           // and noise alike in all directions (points without an image)
  double area_factor = 4;  // a blob's area may differ from the marker's by this factor: the
                           // threshold shrinks a weak blob, halo and motion widen a bright one
  double range_sigma_m = 0.0015;      // of a marker's range, 1 sigma: AHAT's at 0.5 m
  double pixel_sigma_px = 0.1;        // of a centroid, an axis
  double gate_sigmas = 6;             // 3 would lose one true labeling in 20
  double delta_min_m = 0.001;         // the least gate: tool files are not exact, nor is a centroid
  double max_rms_m = 0.0045;          // of the fit, 3 range_sigma_m: beyond it, Reason::bad_fit
  double prior_gate_m = 0.05;         // a hand's 2 m/s over one frame at 45 Hz
  int min_markers_without_prior = 4;  // 3 of many strays agree by chance; 3 for a tool of three
  int min_markers_with_prior = 3;
  int fewer_kept = 1;  // labelings with this many markers fewer than the best are kept
                       // too, in case another tool holds a marker; 0 where there is none
  int hypotheses_max = 20'000;
  int fits_max = 128;
};

// A blob of a few pixels may be wider than its marker by this much whatever the factor.
inline constexpr double k_area_slack_px = 8;

// The tool must be prepared. labelings.reason: none; search_full (the items are the best so far);
// without items too_few_markers, no_labeling (no set has the tool's distances), bad_fit (one had,
// but not its shape) or not_prepared. The prior may be null.
void propose_labelings(const Markers& markers, const Tool& tool, const CorrespondSettings& settings,
                       const Pose* prior_T_camera_tool, Labelings& labelings) noexcept;

}  // namespace glint
