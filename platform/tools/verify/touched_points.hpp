// Classification of static intervals: touches of the first or second point, and the rest.
#pragma once

#include <string>
#include <vector>

#include "platform/tools/calibrate/rotation_spread.hpp"
#include "platform/tools/verify/holds.hpp"

namespace glint {

struct TouchedPoints {
  std::vector<Touch> touches;
  std::vector<bool> is_second;     // touch of the second point
  StaticInterval static_interval;  // the longest interval
  int first_count = 0, second_count = 0, other_count = 0;
  RotationSpread spread;  // of the tool, over all touches

  // Returns what is missing for a check with this many touches of the first point; empty if
  // complete.
  [[nodiscard]] std::string missing(int touches_min) const;
};

// The first point has the most touches; the second is at about this distance from it. A hold as
// long as a rest is not a touch.
[[nodiscard]] TouchedPoints touched_points(const TipSeries& series, double distance_m);

}  // namespace glint
