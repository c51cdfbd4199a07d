// Depth pictures in memory, shown to and fro at a steady rate: a mapping camera for a session.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "kernels/units.hpp"
#include "platform/mapping/depth_sequence.hpp"

namespace glint {

class DepthLoop {
 public:
  // Of none it shows none.
  DepthLoop() = default;
  DepthLoop(DepthSequence sequence, Duration period)
      : sequence_(std::move(sequence)), period_(period) {}

  // Pictures taken by then: the newest one's number, from 1 on.
  [[nodiscard]] std::int64_t newest(Time now) const noexcept {
    if (sequence_.frames.empty() || now < Time{}) return 0;
    return now.nanoseconds / period_.nanoseconds + 1;
  }
  [[nodiscard]] Time time_of(std::int64_t number) const noexcept {
    return Time{} + period_ * (number - 1);
  }
  // To and fro: a pose never jumps.
  [[nodiscard]] const DepthFrame& picture(std::int64_t number) const noexcept {
    const auto last = static_cast<std::int64_t>(sequence_.frames.size()) - 1;
    const std::int64_t turn = last > 0 ? (number - 1) % (2 * last) : 0;
    return sequence_.frames[static_cast<std::size_t>(turn <= last ? turn : 2 * last - turn)];
  }
  [[nodiscard]] const CameraModel& camera() const noexcept { return sequence_.camera; }

 private:
  DepthSequence sequence_;
  Duration period_ = milliseconds(200);
};

}  // namespace glint
