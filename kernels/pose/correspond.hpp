// Which candidate markers are which of a tool's.
//
// What:     all ways to name 3 or more of N candidates as the tool's markers whose distances agree
//           pairwise (pair_matches.hpp), most markers first; of those the k_labelings_max best by
//           the rigid fit's rms. The least rms over all of them decides, not the first that fits: a
//           nearly symmetric tool has several.
// Cost:     one pass over the markers, one over all pairs of candidates, search_steps_max steps of
//           naming a marker, of which a fit takes k_fit_steps.
// Worst:    candidates as dense as the tool itself: the steps end the search, Reason::search_full;
//           the best so far are kept, and what lies near the prediction was tried first.
// Accuracy: complete within the steps. With the default gate of 6 sigma a true labeling is lost
//           once in 10^4 frames (correspond_test.cpp prints the figure); with 8, 20 strays and 5 mm
//           of range noise 13 in 10^5, those among them that chi-square refuses (glint experiment
//           noise). There the least rms names a flat tool wrongly once in 30 frames:
//           decide_labeling.hpp weighs.
// Source:   distance matrix comparison as the seed's; the search: labeling_search.hpp.
//
// With a prediction (the prior):
//   1. First only candidates within prior_gate_m of their predicted places are tried; there, and
//      only there, min_markers_with_prior are enough.
//   2. Then, unless only_near, all candidates are, for labelings of at least
//      min_markers_without_prior markers and no fewer than the best found. Then the
//      markers of the best labeling are, named in other ways: they may have been named wrongly.
//   3. The order stays by count, then rms, then the smaller marker indices; but among labelings
//      with the most markers whose rms the noise cannot tell from the least, count (rms^2 -
//      least^2) <= 9 range_sigma^2 (3 sigma of the likelihood ratio), one with every marker within
//      the prior gate stands before one without: of two mirror-like readings the predicted one is
//      taken.
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

// What the search works in; half a megabyte, of which the part in use is touched.
struct CorrespondScratch {
  Candidates candidates;
  PairMatches matches;
};

struct CorrespondWork {
  int markers = 0;
  PairWork pairs;
  SearchWork search;
};

// The tool must be prepared. labelings.reason: none; search_full (the items are the best so far);
// without items too_few_markers, no_labeling (no set has the tool's distances), bad_fit (one had,
// but not its shape) or not_prepared. The prior may be null.
CorrespondWork propose_labelings(const Markers& markers, const Tool& tool,
                                 const CorrespondSettings& settings,
                                 const Pose* prior_T_camera_tool, CorrespondScratch& scratch,
                                 Labelings& labelings) noexcept GLINT_NONBLOCKING;

}  // namespace glint
