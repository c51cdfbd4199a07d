#include "platform/rt/periodic_loop.hpp"

#include "platform/rt/clock.hpp"

namespace glint {

Tick PeriodicLoop::next() noexcept {
  Tick tick;
  const Time now = monotonic_now();
  const std::int64_t due = (now - first_).nanoseconds / period_.nanoseconds;
  if (now > first_ && due > static_cast<std::int64_t>(next_number_) + catch_up_max_) {
    tick.skipped = static_cast<std::uint32_t>(due) - next_number_;
    next_number_ += tick.skipped;
    skipped_ += tick.skipped;
  }
  tick.number = next_number_++;
  tick.nominal = first_ + period_ * tick.number;
  sleep_until(tick.nominal);
  tick.woken = monotonic_now();
  if (tick.woken >= tick.nominal + period_) ++late_;
  return tick;
}

}  // namespace glint
