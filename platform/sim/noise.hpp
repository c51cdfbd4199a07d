// Noise and signal parameters of the simulated sensor. Noise values are standard deviations.
#pragma once

#include <cstdint>

namespace glint::sim {

// Two kinds of error. A pixel's error is independent in every pixel and frame, so the centroid and
// range of a blob average it. A blob's error is independent in every marker and frame and common to
// all its pixels: it moves the marker's image, or adds to all its depths, as multipath and
// fixed-pattern noise do. The ideal measurement of a marker at range r therefore has the errors
//   across, per axis: blob_pixel_sigma_px pixels, at every range;
//   along the ray:    blob_range_sigma_m * r / 0.5 m (the signal is proportional to 1 / r^2, the
//                     phase error to the inverse root of the signal),
// plus the contribution of the pixels (less than a tenth of it with these defaults).
struct NoiseSettings {
  double blob_pixel_sigma_px = 0.1;
  double blob_range_sigma_m = 0.0015;  // at 0.5 m

  double read_sigma = 6.0;               // reflectivity counts
  double shot_counts = 0.35;             // variance of the reflectivity per count
  double depth_floor_m = 0.0005;         // depth noise of a pixel with a very strong signal
  double depth_at_100_counts_m = 0.006;  // at 100 counts; proportional to 1 / sqrt(counts)
  double signal_min = 20;                // counts; below it the pixel has no depth
  double depth_saturation = 65535;       // counts before clipping; from here on depth is 0
};

// Signal of a marker, a hand or a wall in reflectivity counts at 0.5 m and normal incidence. It is
// inversely proportional to the squared range.
struct SignalSettings {
  double marker = 8000;
  double skin = 330;
  double pen_body = 90;
  double wall = 420;         // albedo 1; the room's surfaces have less
  double sphere_limb = 0.6;  // of the signal, if the line of sight is tangential to the sphere
};

}  // namespace glint::sim
