// How much noise a tool's markers have, which gates follow, and how long may be searched.
#pragma once

#include "kernels/limits.hpp"

namespace glint {

struct CorrespondSettings {
  double focal_px = 0;     // for the area gate and the noise across the ray; 0: no area gate,
                           // and noise alike in all directions (points without an image)
  double area_factor = 4;  // a blob's area may differ from the marker's by this factor: the
                           // threshold shrinks a weak blob, halo and motion widen a bright one
  double range_min_m = 0, range_max_m = 0;  // where tools are expected; 0: anywhere
  double range_sigma_m = 0.0015;            // of a marker's range, 1 sigma: AHAT's at 0.5 m
  double pixel_sigma_px = 0.1;              // of a centroid, an axis
  double gate_sigmas = 6;                   // of a distance; 8 where chi-square decides
  double delta_min_m = 0.001;    // the least gate: tool files are not exact, nor is a centroid
  double max_rms_m = 0.0045;     // of the fit, 3 range_sigma_m: beyond it, Reason::bad_fit
  double prior_gate_m = 0.05;    // a hand's 2 m/s over one frame at 45 Hz
  double prior_sigma_m = 0.006;  // of a predicted marker's place, an axis
  // For labelings of fewer markers than min_markers_without_prior, which agree by chance where many
  // strays are near: no further than the tool can have got. At most prior_gate_m counts.
  double few_gate_m = 0.05;
  // A prediction that is sure within prior_gate_m: what lies beyond is another tool's, or a stray.
  bool only_near = false;
  int min_markers_without_prior = 4;  // 3 of many strays agree by chance; 3 for a tool of three
  int min_markers_with_prior = 3;
  int fewer_kept = 1;             // labelings with this many markers fewer than the best are kept
                                  // too, in case another tool holds a marker; 0 where there is none
  int markers_max = k_blobs_max;  // looked at; of these at most, in their order
  int search_steps_max = k_search_steps_max;  // of the search; a fit counts as k_fit_steps
};

// What a fit costs beside naming one more marker, in time and, nearly, in instructions.
inline constexpr int k_fit_steps = 32;

// Beyond the expected range by this factor a marker is none: a small spot on a bright hand would
// else be taken for one a whole wrap of the ranges behind it.
inline constexpr double k_range_margin = 1.1;

// A blob of a few pixels may be wider than its marker by this much whatever the factor.
inline constexpr double k_area_slack_px = 8;

}  // namespace glint
