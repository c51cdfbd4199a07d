#include "platform/runtime/rt/clock_map.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

Duration from_seconds(double s) { return {static_cast<std::int64_t>(std::llround(s * 1e9))}; }

}  // namespace

void ClockMap::begin(Time stamp, Time arrival) noexcept {
  begun_ = true;
  origin_ = stamp;
  base_ = arrival - stamp;
  bins_ = {};
  slope_ = offset_s_ = mean_s_ = 0;
  scatter_s_ = 0;
  mapped_ = 0;
  refused_in_row_ = 0;
}

std::optional<Time> ClockMap::map(Time stamp, Time arrival) noexcept {
  if (!begun_) begin(stamp, arrival);
  const double x = x_of(stamp);
  const Duration difference = arrival - stamp;
  const double y = (difference - base_).seconds();
  if (std::abs(y - (offset_s_ + slope_ * (x - mean_s_))) > k_step.seconds()) {
    const Duration apart = difference - refused_difference_;
    const bool agrees = refused_in_row_ > 0 && apart <= k_agree && Duration{} - apart <= k_agree;
    refused_in_row_ = agrees ? refused_in_row_ + 1 : 1;
    if (!agrees) refused_difference_ = difference;
    if (refused_in_row_ <= k_agreeing) {
      ++refused_;
      return std::nullopt;
    }
    ++restarts_;
    begin(stamp, arrival);
    return map(stamp, arrival);
  }
  refused_in_row_ = 0;
  ++mapped_;
  const auto number = static_cast<std::int64_t>(std::floor(x / k_bin.seconds()));
  Bin& bin = bins_[static_cast<std::size_t>((number % k_bins + k_bins) % k_bins)];
  const double expected = slope_ * (x - bin.x_s);  // drift since the minimum of this bin
  if (bin.number != number || y < bin.y_s + expected) {
    bin = {number, x, y};
    fit();
  }
  const double line = offset_s_ + slope_ * (x - mean_s_);
  const Time mapped = stamp + base_ + from_seconds(line) - earliest_delay_;
  return std::min(mapped, arrival);
}

void ClockMap::fit() noexcept {
  double n = 0, sum_x = 0, sum_y = 0;
  for (const Bin& bin : bins_) {
    if (bin.number < 0) continue;
    ++n;
    sum_x += bin.x_s;
    sum_y += bin.y_s;
  }
  mean_s_ = sum_x / n;
  offset_s_ = sum_y / n;
  double xx = 0, xy = 0;
  for (const Bin& bin : bins_) {
    if (bin.number < 0) continue;
    xx += (bin.x_s - mean_s_) * (bin.x_s - mean_s_);
    xy += (bin.x_s - mean_s_) * (bin.y_s - offset_s_);
  }
  // In less than three seconds the scatter of the delays would look like drift.
  slope_ = n > 3 ? std::clamp(xy / xx, -k_drift_max, k_drift_max) : 0;
  if (n < 2) return;
  double square = 0, least = 0;
  for (const Bin& bin : bins_) {
    if (bin.number < 0) continue;
    const double off = bin.y_s - (offset_s_ + slope_ * (bin.x_s - mean_s_));
    square += off * off;
    least = std::min(least, off);
  }
  offset_s_ += least;  // no delay is shorter than the earliest
  scatter_s_ = std::sqrt(square / (n - 1));
}

Duration ClockMap::uncertainty() const noexcept {
  const double above =
      k_delay_sigma.seconds() / static_cast<double>(std::max<std::int64_t>(mapped_, 1));
  return from_seconds(std::hypot(scatter_s_, above));
}

}  // namespace glint
