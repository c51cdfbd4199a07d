// Depth bias of a time-of-flight sensor on one kind of marker, by range and brightness.
//
// What:     offset + slope by range + a part that grows as the marker's signal gets low. Outside
//           the measured ranges the bias keeps its value at the nearer end.
// Cost:     ten operations.
// Worst:    data independent.
// Accuracy: that of the fit that gave the figures; none are built in.
// Source:   time-of-flight ranges err by range and by signal: Foix, Alenya, Torras, "Lock-in
//           Time-of-Flight (ToF) Cameras: A Survey", IEEE Sensors Journal 11 (2011), section II.
#pragma once

#include <algorithm>
#include <cstdint>

namespace glint {

struct DepthBias {
  double offset_m = 0;   // at k_reference_m, of an infinitely bright marker
  double per_metre = 0;  // slope by range
  // Low-signal part at a peak of k_reference_counts; doubles at half of it.
  double low_signal_m = 0;
  double range_min_m = 0;  // lower end of the measured ranges
  double range_max_m = 0;  // upper end; 0: not measured, the bias is 0

  static constexpr double k_reference_m = 0.5;
  static constexpr double k_reference_counts = 1000;

  [[nodiscard]] bool is_measured() const noexcept { return range_max_m > 0; }

  // Returns by how many metres the range is too long. range_m: as measured. peak: the marker's
  // brightest pixel, raw.
  [[nodiscard]] double at(double range_m, std::uint16_t peak) const noexcept {
    if (!is_measured()) return 0;
    const double range = std::max(range_min_m, std::min(range_m, range_max_m));
    const double counts = std::max<double>(peak, 1);
    return offset_m + per_metre * (range - k_reference_m) +
           low_signal_m * (k_reference_counts / counts);
  }
};

}  // namespace glint
