#include "platform/tools/verify/holds.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr double k_block_s = 0.25;
constexpr double k_moved_m = 0.010;  // between blocks; the mean of a block errs by about 1 mm
constexpr std::size_t k_sightings_min = 2;  // per block: a camera delivers at least 5 frames/s

struct Block {
  Hold hold;
  Vector3 tip_m = Vector3::Zero(), middle_m = Vector3::Zero();
};

// Variance from the headset and the frame's noise; large just after head motion.
double variance_of(const TipSighting& one) {
  return (one.random_m2 + one.by_head * one.by_head.transpose() + one.moving_m2).trace();
}

double seconds_of(const TipSeries& series, std::size_t first, std::size_t end) {
  return (series.sightings[end - 1].time - series.sightings[first].time).seconds();
}

std::vector<Block> blocks_of(const TipSeries& series) {
  std::vector<Block> blocks;
  const std::size_t all = series.sightings.size();
  for (std::size_t first = 0; first < all;) {
    std::size_t end = first + 1;
    while (end < all && seconds_of(series, first, end + 1) < k_block_s) ++end;
    const std::size_t count = end - first;
    if (count >= k_sightings_min) {
      Block block{{first, count, 0}};
      for (std::size_t i = first; i < end; ++i) {
        block.tip_m += series.sightings[i].tip_m / static_cast<double>(count);
        block.middle_m += series.sightings[i].middle_m / static_cast<double>(count);
      }
      blocks.push_back(block);
    }
    first = end;
  }
  return blocks;
}

bool goes_on(const TipSeries& series, const Block& before, const Block& next) {
  const std::size_t end = before.hold.first + before.hold.count;
  return seconds_of(series, end - 1, next.hold.first + 1) < 2 * k_block_s &&
         (next.tip_m - before.tip_m).norm() < k_moved_m &&
         (next.middle_m - before.middle_m).norm() < k_moved_m;
}

}  // namespace

std::vector<Hold> find_holds(const TipSeries& series) {
  const std::vector<Block> blocks = blocks_of(series);
  std::vector<Hold> holds;
  for (std::size_t first = 0; first < blocks.size();) {
    std::size_t end = first + 1;
    while (end < blocks.size() && goes_on(series, blocks[end - 1], blocks[end])) ++end;
    if (end - first > 2) {
      const Hold& last = blocks[end - 2].hold;
      Hold hold{blocks[first + 1].hold.first, 0, 0};
      hold.count = last.first + last.count - hold.first;
      hold.seconds = seconds_of(series, hold.first, hold.first + hold.count);
      if (hold.seconds >= k_hold_min_s) holds.push_back(hold);
    }
    first = end;
  }
  return holds;
}

Touch mean_of(const TipSeries& series, const Hold& hold) {
  const std::span<const TipSighting> all =
      std::span(series.sightings).subspan(hold.first, hold.count);
  double sum = 0, squares = 0;
  for (const TipSighting& one : all) {
    const double weight = 1 / variance_of(one);
    sum += weight;
    squares += weight * weight;
  }
  Touch touch;
  TipSighting& mean = touch.mean;
  double seconds = 0;
  for (const TipSighting& one : all) {
    const double part = 1 / (variance_of(one) * sum);
    mean.tip_m += part * one.tip_m;
    mean.middle_m += part * one.middle_m;
    mean.random_m2 += part * part * one.random_m2;
    mean.by_calibration += part * one.by_calibration;
    mean.by_markers += part * one.by_markers;
    mean.by_head += part * one.by_head;
    mean.moving_m2 += part * one.moving_m2;
    mean.range_m += part * one.range_m;
    seconds += part * (one.time - all.front().time).seconds();
  }
  mean.time = all.front().time + Duration{static_cast<std::int64_t>(1e9 * seconds)};
  mean.rotation = all[all.size() / 2].rotation;
  touch.seconds = hold.seconds * sum * sum / (squares * static_cast<double>(all.size()));
  return touch;
}

std::vector<Touch> pieces_of(const TipSeries& series, const Hold& hold, double seconds) {
  std::vector<Touch> pieces;
  const std::size_t end = hold.first + hold.count;
  for (std::size_t first = hold.first; first < end;) {
    std::size_t next = first + 1;
    while (next < end && seconds_of(series, first, next + 1) < seconds) ++next;
    const Hold piece{first, next - first, seconds_of(series, first, next)};
    if (piece.seconds > 0.5 * seconds) pieces.push_back(mean_of(series, piece));
    first = next;
  }
  return pieces;
}

}  // namespace glint
