// Noise model of a sensor's pixels: read, shot and proportional noise, 1 sigma, raw counts.
#pragma once

namespace glint {

// Variance of a pixel that holds I counts: read^2 + shot I + (proportional I)^2.
struct PixelNoise {
  double read_counts = 6;      // in the dark
  double shot_counts = 0.35;   // variance per count
  double proportional = 0.01;  // differences of area, lens and gain between pixels
};

}  // namespace glint
