// What the sensor adds to a perfect picture. Every figure is a declared parameter, 1 sigma.
#pragma once

#include <cstdint>

namespace glint::sim {

// Two kinds of error. A pixel's is new in every pixel and frame, so that a blob's centroid and
// range average it out. A blob's is new in every marker and frame and common to all its pixels: it
// moves the marker's whole image, or adds to all its depths, as multi-path and the sensor's fixed
// pattern do. A good measurement of a marker at range r therefore has
//   across, each axis: blob_pixel_sigma_px pixels, at every range;
//   along the ray:     blob_range_sigma_m * r / 0.5 m (the signal falls with r squared, and the
//                      phase's error with the root of the signal),
// with the pixels' share on top (below a tenth of it by these defaults).
struct NoiseSettings {
  double blob_pixel_sigma_px = 0.1;
  double blob_range_sigma_m = 0.0015;  // at 0.5 m

  double read_sigma = 6.0;               // reflectivity counts
  double shot_counts = 0.35;             // variance of the reflectivity, per count of it
  double depth_floor_m = 0.0005;         // depth of a pixel with a very strong signal
  double depth_at_100_counts_m = 0.006;  // depth of a pixel with 100 counts; falls with the root
  double signal_min = 20;                // counts; below it the pixel has no depth
  double depth_saturation = 65535;       // counts before clipping; from here on depth is 0
};

// What a marker, a hand or a wall sends back, in reflectivity counts at 0.5 m seen head on; it
// falls with the range squared.
struct SignalSettings {
  double marker = 8000;
  double skin = 330;
  double pen_body = 90;
  double wall = 420;         // albedo 1; the room's surfaces have less
  double sphere_limb = 0.6;  // of the signal where the line of sight grazes the sphere
};

}  // namespace glint::sim
