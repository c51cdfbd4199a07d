#include "platform/tools/programming/stroke_segments.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "kernels/motion/interpolate.hpp"

namespace glint {
namespace {

using Points = std::vector<UncertainPose>;

constexpr double k_arc_gain_min = 1.5;  // an arc is this many times as long as the line

// Quantile of the chi-square distribution (Wilson and Hilferty 1931).
double chi_square_limit(double freedom, double sigma) {
  const double part = 2 / (9 * freedom);
  return freedom * std::pow(1 - part + sigma * std::sqrt(part), 3);
}

bool turns_evenly(const Points& points, std::size_t first, std::size_t last, double turn_max_rad) {
  double length = 0;
  for (std::size_t i = first + 1; i <= last; ++i)
    length += (points[i].pose.translation - points[i - 1].pose.translation).norm();
  double done = 0;
  const Quaternion &from = points[first].pose.rotation, &to = points[last].pose.rotation;
  for (std::size_t i = first + 1; i < last; ++i) {
    done += (points[i].pose.translation - points[i - 1].pose.translation).norm();
    const Quaternion expected = slerp(from, to, length > 0 ? std::min(done / length, 1.0) : 0);
    if (rotation_vector(expected.conjugate() * points[i].pose.rotation).norm() > turn_max_rad)
      return false;
  }
  return true;
}

using Fit = std::function<std::optional<StrokeSegment>(std::size_t first, std::size_t last)>;

class Divider {
 public:
  Divider(const Points& points, const SegmentSettings& settings)
      : points_(points), settings_(settings) {}

  std::vector<StrokeSegment> run() const {
    std::vector<StrokeSegment> segments;
    for (std::size_t first = 0; first + 1 < points_.size();) {
      const StrokeSegment next = longest_at(first);
      const bool joins = next.kind == SegmentKind::free && !segments.empty() &&
                         segments.back().kind == SegmentKind::free;
      if (joins) {
        segments.back().last = next.last;
      } else {
        segments.push_back(next);
      }
      first = next.last;
    }
    for (std::size_t i = 1; i < segments.size(); ++i) move_junction(segments[i - 1], segments[i]);
    return segments;
  }

 private:
  std::optional<StrokeSegment> line(std::size_t first, std::size_t last) const {
    return accepted(line_through(points_, first, last), 4);
  }
  std::optional<StrokeSegment> arc(std::size_t first, std::size_t last) const {
    return accepted(arc_through(points_, first, last, settings_.radius_max_m), 6);
  }
  std::optional<StrokeSegment> accepted(std::optional<StrokeSegment> fit, double unknowns) const {
    if (!fit) return {};
    const double freedom = 2.0 * static_cast<double>(fit->last - fit->first + 1) - unknowns;
    const bool agrees = freedom > 0 &&
                        fit->chi_square <= chi_square_limit(freedom, settings_.quantile_sigma) &&
                        turns_evenly(points_, fit->first, fit->last, settings_.turn_max_rad);
    return agrees ? fit : std::nullopt;
  }

  // The largest of the runs that double in size, then longer by bisection. A short run may fail
  // where a longer one agrees: few points hardly determine an arc.
  std::optional<StrokeSegment> longest(std::size_t first, std::size_t count, const Fit& fit) const {
    const std::size_t all = points_.size() - 1 - first;  // steps to the last point
    if (count - 1 > all) return {};
    if (const auto whole = fit(first, first + all)) return whole;
    std::optional<StrokeSegment> best;
    std::size_t low = 0;
    for (std::size_t size = count - 1; size < all; size *= 2) {
      if (const auto next = fit(first, first + size)) {
        best = next;
        low = size;
      }
    }
    std::size_t high = std::min(2 * low, all);
    while (best && high - low > 1) {
      const std::size_t middle = low + (high - low) / 2;
      if (const auto next = fit(first, first + middle)) {
        best = next;
        low = middle;
      } else {
        high = middle;
      }
    }
    return best;
  }

  StrokeSegment longest_at(std::size_t first) const {
    const auto straight =
        longest(first, settings_.points_min, [&](auto a, auto b) { return line(a, b); });
    const auto round =
        longest(first, settings_.points_min + 2, [&](auto a, auto b) { return arc(a, b); });
    const double straight_points = straight ? static_cast<double>(straight->last - first) : 0;
    if (round && static_cast<double>(round->last - first) > k_arc_gain_min * straight_points)
      return *round;
    if (straight) return *straight;
    return {SegmentKind::free, first, first + 1};
  }

  std::optional<StrokeSegment> again(const StrokeSegment& segment, std::size_t first,
                                     std::size_t last) const {
    const std::size_t count =
        segment.kind == SegmentKind::line ? settings_.points_min : settings_.points_min + 2;
    if (last < first + count - 1) return {};
    return segment.kind == SegmentKind::line ? line(first, last) : arc(first, last);
  }

  // A run includes some points beyond a corner that the noise hides.
  void move_junction(StrokeSegment& before, StrokeSegment& after) const {
    if (before.kind == SegmentKind::free || after.kind == SegmentKind::free) return;
    const StrokeSegment first = before, second = after;
    double least = first.chi_square + second.chi_square;
    for (std::size_t at = first.first + 1; at < first.last; ++at) {
      const auto shorter = again(first, first.first, at), longer = again(second, at, second.last);
      if (!shorter || !longer || shorter->chi_square + longer->chi_square >= least) continue;
      least = shorter->chi_square + longer->chi_square;
      before = *shorter;
      after = *longer;
    }
  }

  const Points& points_;
  const SegmentSettings& settings_;
};

}  // namespace

std::vector<StrokeSegment> stroke_segments(const std::vector<UncertainPose>& points,
                                           const SegmentSettings& settings) {
  return Divider(points, settings).run();
}

}  // namespace glint
