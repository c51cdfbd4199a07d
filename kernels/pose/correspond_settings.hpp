// Settings of the correspondence search: marker noise, gates and step budget.
#pragma once

#include "kernels/limits.hpp"

namespace glint {

struct CorrespondSettings {
  double focal_px = 0;     // for the area gate and the noise across the ray; 0: no area gate, and
                           // isotropic noise (points without an image)
  double area_factor = 4;  // a blob's area may differ from the marker's by this factor: low signal
                           // shrinks a blob, halo and motion blur widen it
  double range_min_m = 0, range_max_m = 0;  // range limits of the tools; 0: none
  double range_sigma_m = 0.0015;            // of a marker's range, 1 sigma: AHAT's at 0.5 m
  double pixel_sigma_px = 0.1;              // of a centroid, per axis
  double gate_sigmas = 6;                   // of a distance; 8 if a chi-square test follows
  double delta_min_m = 0.001;               // minimum gate, for errors of tool files and centroids
  double max_rms_m = 0.0045;                // of the fit, 3 range_sigma_m; above it Reason::bad_fit
  double prior_gate_m = 0.05;               // a hand's 2 m/s over one frame at 45 Hz
  double prior_sigma_m = 0.006;             // of a predicted marker's position, per axis
  // Gate for labelings of fewer markers than min_markers_without_prior, which agree by chance among
  // many stray reflections: the tool's largest possible motion. At most prior_gate_m counts.
  double partial_gate_m = 0.05;
  // True if the tool is certainly within prior_gate_m of its prediction: markers beyond it are
  // another tool's or stray reflections.
  bool only_near = false;
  int min_markers_without_prior = 4;  // 3 of many false markers agree by chance; a tool of three: 3
  int min_markers_with_prior = 3;
  int fewer_markers_max = 1;      // labelings with this many markers fewer than the best are kept
                                  // too, in case another tool holds a marker; 0 with a single tool
  int markers_max = k_blobs_max;  // maximum number of markers read, in their order
  int search_steps_max = k_search_steps_max;  // of the search; a fit counts as k_fit_steps
};

// Cost of a fit in assignment steps, by time and, nearly, by instructions.
inline constexpr int k_fit_steps = 32;

// A marker beyond the range limits by this factor is rejected. Otherwise a small specular
// reflection on a bright hand would count as a marker one wrap distance behind it.
inline constexpr double k_range_margin = 1.1;

// Area in pixels by which a small blob may exceed its marker, whatever the factor.
inline constexpr double k_area_slack_px = 8;

}  // namespace glint
