// By how much a sensor's ranges to one kind of marker are too long, and taking that off.
//
// What:     offset + slope by range + a part that grows as the marker gets dim; beyond the ranges
//           that it was measured at it stays what it is at the nearer end.
// Cost:     ten operations.
// Worst:    none is worse than another.
// Accuracy: that of the fit which gave the figures; none are built in.
// Source:   time-of-flight ranges err by range and by signal: Foix, Alenya, Torras, "Lock-in
//           Time-of-Flight (ToF) Cameras: A Survey", IEEE Sensors Journal 11 (2011), section II.
#pragma once

#include <algorithm>
#include <cstdint>

namespace glint {

struct DepthBias {
  double offset_m = 0;     // at k_reference_m, of a marker as bright as can be
  double per_metre = 0;    // more at longer ranges
  double dim_m = 0;        // at a peak of k_reference_counts; twice as much at half of that
  double range_min_m = 0;  // measured from here
  double range_max_m = 0;  // to here; 0: nothing was measured, nothing is taken off

  static constexpr double k_reference_m = 0.5;
  static constexpr double k_reference_counts = 1000;

  [[nodiscard]] bool is_measured() const noexcept { return range_max_m > 0; }

  // range_m: as measured. peak: the marker's brightest pixel, raw.
  [[nodiscard]] double at(double range_m, std::uint16_t peak) const noexcept {
    if (!is_measured()) return 0;
    const double range = std::max(range_min_m, std::min(range_m, range_max_m));
    const double counts = std::max<double>(peak, 1);
    return offset_m + per_metre * (range - k_reference_m) + dim_m * (k_reference_counts / counts);
  }
};

}  // namespace glint
