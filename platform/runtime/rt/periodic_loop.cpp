#include "platform/runtime/rt/periodic_loop.hpp"

namespace glint {

std::optional<Tick> PeriodicLoop::next() noexcept {
  Tick tick;
  const Time now = monotonic_now();
  const std::uint64_t due =
      now > first_ ? static_cast<std::uint64_t>((now - first_).nanoseconds / period_.nanoseconds)
                   : 0;
  if (due > next_number_ + catch_up_max_) {
    tick.skipped = due - next_number_;
    next_number_ = due;
    skipped_ += tick.skipped;
  }
  tick.number = next_number_++;
  tick.nominal = first_ + period_ * static_cast<std::int64_t>(tick.number);
  (void)sleep_(tick.nominal);  // a failure is detected below
  tick.woken = monotonic_now();
  // Tick numbers increase, so at most one tick per period passes this test.
  if (tick.woken < tick.nominal) return std::nullopt;
  if (tick.woken >= tick.nominal + period_) ++late_;
  return tick;
}

}  // namespace glint
