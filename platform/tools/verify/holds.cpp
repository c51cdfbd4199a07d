#include "platform/tools/verify/holds.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr double k_block_s = 0.25;
constexpr double k_moved_m = 0.010;  // between blocks; the mean of a block errs by about 1 mm
constexpr std::size_t k_observations_min = 2;  // per block: a camera delivers at least 5 frames/s

struct Block {
  StaticInterval interval;
  Vector3 tip_m = Vector3::Zero(), centroid_m = Vector3::Zero();
};

// Variance from the headset and the frame's noise; large just after head motion.
double variance_of(const TipObservation& one) {
  return (one.random_m2 + one.by_head * one.by_head.transpose() + one.motion_covariance_m2).trace();
}

double seconds_of(const TipSeries& series, std::size_t first, std::size_t end) {
  return (series.observations[end - 1].time - series.observations[first].time).seconds();
}

std::vector<Block> blocks_of(const TipSeries& series) {
  std::vector<Block> blocks;
  const std::size_t all = series.observations.size();
  for (std::size_t first = 0; first < all;) {
    std::size_t end = first + 1;
    while (end < all && seconds_of(series, first, end + 1) < k_block_s) ++end;
    const std::size_t count = end - first;
    if (count >= k_observations_min) {
      Block block{{first, count, 0}};
      for (std::size_t i = first; i < end; ++i) {
        block.tip_m += series.observations[i].tip_m / static_cast<double>(count);
        block.centroid_m += series.observations[i].centroid_m / static_cast<double>(count);
      }
      blocks.push_back(block);
    }
    first = end;
  }
  return blocks;
}

bool goes_on(const TipSeries& series, const Block& before, const Block& next) {
  const std::size_t end = before.interval.first + before.interval.count;
  return seconds_of(series, end - 1, next.interval.first + 1) < 2 * k_block_s &&
         (next.tip_m - before.tip_m).norm() < k_moved_m &&
         (next.centroid_m - before.centroid_m).norm() < k_moved_m;
}

}  // namespace

std::vector<StaticInterval> find_static_intervals(const TipSeries& series) {
  const std::vector<Block> blocks = blocks_of(series);
  std::vector<StaticInterval> intervals;
  for (std::size_t first = 0; first < blocks.size();) {
    std::size_t end = first + 1;
    while (end < blocks.size() && goes_on(series, blocks[end - 1], blocks[end])) ++end;
    if (end - first > 2) {
      const StaticInterval& last = blocks[end - 2].interval;
      StaticInterval interval{blocks[first + 1].interval.first, 0, 0};
      interval.count = last.first + last.count - interval.first;
      interval.seconds = seconds_of(series, interval.first, interval.first + interval.count);
      if (interval.seconds >= k_static_min_s) intervals.push_back(interval);
    }
    first = end;
  }
  return intervals;
}

Touch mean_of(const TipSeries& series, const StaticInterval& interval) {
  const std::span<const TipObservation> all =
      std::span(series.observations).subspan(interval.first, interval.count);
  double sum = 0, squares = 0;
  for (const TipObservation& one : all) {
    const double weight = 1 / variance_of(one);
    sum += weight;
    squares += weight * weight;
  }
  Touch touch;
  TipObservation& mean = touch.mean;
  double seconds = 0;
  for (const TipObservation& one : all) {
    const double part = 1 / (variance_of(one) * sum);
    mean.tip_m += part * one.tip_m;
    mean.centroid_m += part * one.centroid_m;
    mean.random_m2 += part * part * one.random_m2;
    mean.by_calibration += part * one.by_calibration;
    mean.by_markers += part * one.by_markers;
    mean.by_head += part * one.by_head;
    mean.motion_covariance_m2 += part * one.motion_covariance_m2;
    mean.range_m += part * one.range_m;
    seconds += part * (one.time - all.front().time).seconds();
  }
  mean.time = all.front().time + Duration{static_cast<std::int64_t>(1e9 * seconds)};
  mean.rotation = all[all.size() / 2].rotation;
  touch.seconds = interval.seconds * sum * sum / (squares * static_cast<double>(all.size()));
  return touch;
}

std::vector<Touch> pieces_of(const TipSeries& series, const StaticInterval& interval,
                             double seconds) {
  std::vector<Touch> pieces;
  const std::size_t end = interval.first + interval.count;
  for (std::size_t first = interval.first; first < end;) {
    std::size_t next = first + 1;
    while (next < end && seconds_of(series, first, next + 1) < seconds) ++next;
    const StaticInterval piece{first, next - first, seconds_of(series, first, next)};
    if (piece.seconds > 0.5 * seconds) pieces.push_back(mean_of(series, piece));
    first = next;
  }
  return pieces;
}

}  // namespace glint
