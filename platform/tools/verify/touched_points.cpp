#include "platform/tools/verify/touched_points.hpp"

#include <algorithm>
#include <cmath>

#include "platform/tools/calibrate/figure_text.hpp"
#include "platform/tools/calibrate/pivot.hpp"

namespace glint {
namespace {

bool near(const Touch& touch, const Vector3& point, double within_m) {
  return (touch.mean.tip_m - point).norm() < within_m;
}

// Tip position with the most touches near it. Requires at least one touch.
Vector3 most_touched(const std::vector<Touch>& touches, double within_m) {
  const auto count = [&](const Touch& of) {
    return std::count_if(touches.begin(), touches.end(),
                         [&](const Touch& touch) { return near(touch, of.mean.tip_m, within_m); });
  };
  return std::max_element(touches.begin(), touches.end(),
                          [&](const Touch& a, const Touch& b) { return count(a) < count(b); })
      ->mean.tip_m;
}

void add(const std::vector<Touch>& touches, const Vector3& point, double within_m, bool is_second,
         TouchedPoints& out) {
  for (const Touch& touch : touches) {
    if (!near(touch, point, within_m)) continue;
    out.touches.push_back(touch);
    out.is_second.push_back(is_second);
    ++(is_second ? out.second_count : out.first_count);
  }
}

}  // namespace

TouchedPoints touched_points(const TipSeries& series, double distance_m) {
  TouchedPoints out;
  const double within_m = 0.5 * distance_m;
  std::vector<Touch> held;
  for (const StaticInterval& interval : find_static_intervals(series)) {
    if (interval.seconds > out.static_interval.seconds) out.static_interval = interval;
    if (interval.seconds < k_rest_min_s) held.push_back(mean_of(series, interval));
  }
  if (held.empty()) return out;
  const Vector3 first = most_touched(held, within_m);
  add(held, first, within_m, false, out);
  std::vector<Touch> apart;
  for (const Touch& touch : held) {
    const double from_first_m = (touch.mean.tip_m - first).norm();
    if (std::abs(from_first_m - distance_m) < within_m) apart.push_back(touch);
  }
  if (!apart.empty()) add(apart, most_touched(apart, within_m), within_m, true, out);
  out.other_count = static_cast<int>(held.size() - out.touches.size());
  std::vector<TimedPose> poses;
  for (const Touch& touch : out.touches)
    poses.push_back({touch.mean.time, {touch.mean.rotation, touch.mean.tip_m}});
  out.spread = rotation_spread(poses);
  return out;
}

std::string TouchedPoints::missing(int touches_min) const {
  const std::string how = ": hold the tip on the point for three seconds each time";
  if (first_count < touches_min) {
    return std::to_string(first_count) + " touches of one point; expected at least " +
           std::to_string(touches_min) + how;
  }
  if (second_count == 0) {
    return "no touch of a second point at the known distance; expected one or more" + how;
  }
  const double spread_min_rad = PivotSettings{}.spread_min_rad;
  if (spread.spread_rad[0] < spread_min_rad) {
    return "the touches are too similar: the tool's direction " +
           format_direction(spread.directions.col(0)) + " differs by " +
           format_degrees(spread.spread_rad[0]) + " rms; expected at least " +
           format_degrees(spread_min_rad) + ": lean the tool to another side at each touch";
  }
  if (static_interval.seconds < k_rest_min_s) {
    return "the tool rests for " + format_number("%.1f s", static_interval.seconds) +
           " at most; expected 20 s in one place";
  }
  return {};
}

}  // namespace glint
