// Which holds of a series touch which of two points, and which is the rest.
#pragma once

#include <string>
#include <vector>

#include "platform/calibrate/rotation_spread.hpp"
#include "platform/verify/holds.hpp"

namespace glint {

struct TouchedPoints {
  std::vector<Touch> touches;
  std::vector<bool> is_second;  // of the second point
  Hold rest;                    // the longest hold
  int first_count = 0, second_count = 0, other_count = 0;
  RotationSpread spread;  // of the tool, over all touches

  // What a check of this many touches of the first point still wants; empty: nothing.
  [[nodiscard]] std::string lacks(int touches_min) const;
};

// The first point is the one that most holds touch, the second lies about this far from it. A hold
// that lasts as long as a rest is no touch.
[[nodiscard]] TouchedPoints touched_points(const TipSeries& series, double distance_m);

}  // namespace glint
