// Optical errors of the simulated sensor: point spread, halo, stray light, hot pixels.
//
// What:     each pixel's light spreads over its neighbours and over a halo of k_halo_px; stray
//           light adds the same signal to every pixel, by a longer way; hot pixels have a fixed
//           signal and range. Ranges mix weighted by signal. So an edge between a near and a far
//           surface gives flying pixels, and stray light shifts the range of dim pixels more than
//           of bright ones.
// Accuracy: the core as in the source's frame; the halo within a factor of two.
// Source:   point spread: a point-like glint of 3,096 counts in a HoloLens 2 frame published with
//           IRToolTrackingWithHololens2 (dba826c4, MIT): full width at half maximum 1.6 px, 1 % at
//           3 px, 7 to 23 counts above the background at 5 px. Stray light: Foix, Alenya, Torras,
//           "Lock-in Time-of-Flight (ToF) Cameras: A Survey", IEEE Sensors Journal 11 (2011),
//           section II.
#pragma once

#include "platform/sim/device_errors.hpp"
#include "platform/sim/planes.hpp"

namespace glint::sim {

inline constexpr int k_halo_px = 6;

// scratch: a buffer, overwritten.
void add_stray_light(const DeviceErrors& device, Planes& scratch, Planes& planes);

}  // namespace glint::sim
