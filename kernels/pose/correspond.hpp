// Correspondence search: labelings of candidate markers as a tool's markers, by their pairwise
// distances.
//
// What:     all assignments of 3 or more of N candidates to the tool's markers whose distances
//           agree pairwise (pair_matches.hpp), most markers first. Of those it keeps the
//           k_labelings_max best by the rigid fit's rms. The least rms over all of them decides,
//           not the first that fits: a nearly symmetric tool has several.
// Cost:     one pass over the markers, one over all pairs of candidates, at most search_steps_max
//           assignment steps; a fit counts as k_fit_steps.
// Worst:    candidates as dense as the tool itself: the step budget ends the search,
//           Reason::search_full. The best so far are kept, and candidates near the prediction were
//           tried first.
// Accuracy: complete within the step budget. With the default gate of 6 sigma, the search loses a
//           true labeling once in 10^4 frames (correspond_test.cpp prints the figure). With 8
//           sigma, 20 stray reflections and 5 mm of range noise it loses 13 in 10^5, including
//           those that the chi-square test rejects (glint experiment noise). There the least rms
//           chooses a wrong labeling of a flat tool once in 30 frames; decide_labeling.hpp weights
//           each marker by its noise.
// Source:   distance matrix comparison as in Puljiz et al.; the search: labeling_search.hpp.
//
// With a prediction (the prior):
//   1. The search first tries only candidates within prior_gate_m of their predicted positions.
//      Only there, within partial_gate_m, are labelings of fewer than min_markers_without_prior
//      markers allowed, but at least min_markers_with_prior.
//   2. Unless only_near is set, it then tries all candidates, for labelings of at least
//      min_markers_without_prior markers and at most fewer_markers_max fewer than the best found.
//      Finally it tries other labelings of the best one's markers, which may have been swapped.
//   3. The order remains by count, then rms, then the smaller marker indices, with one exception.
//      Consider the labelings with the most markers whose rms does not differ significantly from
//      the least: count (rms^2 - least^2) <= 9 range_sigma^2 (3 sigma of the likelihood ratio).
//      Of these, one with every marker within the prior gate comes first. So the search prefers
//      the predicted one of two mirror-like labelings.
#pragma once

#include "kernels/nonblocking.hpp"
#include "kernels/pose/candidates.hpp"
#include "kernels/pose/correspond_settings.hpp"
#include "kernels/pose/labeling.hpp"
#include "kernels/pose/labeling_search.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/pair_matches.hpp"
#include "kernels/pose/tool.hpp"

namespace glint {

// Scratch memory of the search: half a megabyte, of which only the part in use is touched.
struct CorrespondScratch {
  Candidates candidates;
  PairMatches matches;
};

struct CorrespondWork {
  int markers = 0;
  PairWork pairs;
  SearchWork search;
};

// Requires a prepared tool. labelings.reason: none; search_full (the items are the best so far);
// without items too_few_markers, no_labeling (no set has the tool's distances), bad_fit (a set has
// its distances, but not its shape) or not_prepared. The prior may be null.
CorrespondWork propose_labelings(const Markers& markers, const Tool& tool,
                                 const CorrespondSettings& settings,
                                 const Pose* prior_T_camera_tool, CorrespondScratch& scratch,
                                 Labelings& labelings) noexcept GLINT_NONBLOCKING;

}  // namespace glint
