// Periodic loop with a fixed time base: tick n is due at first + n * period. Slightly late ticks
// run at once, one after the other; beyond catch_up_max, ticks are skipped and counted.
#pragma once

#include <cstdint>
#include <optional>

#include "kernels/units.hpp"
#include "platform/runtime/rt/clock.hpp"

namespace glint {

struct Tick {
  std::uint64_t number = 0;
  Time nominal;               // first + number * period: the only time that the output reads
  Time woken;                 // actual start
  std::uint64_t skipped = 0;  // ticks that never ran since the previous one
};

// Message of a run that stopped for this reason.
inline constexpr const char* k_no_sleep_message =
    "ticks: the sleep until the next tick failed and the run stopped; expected a working "
    "CLOCK_MONOTONIC sleep";

class PeriodicLoop {
 public:
  using Sleep = bool (*)(Time wake) noexcept;

  // period > 0. `catch_up_max`: number of due ticks beyond which they are skipped.
  PeriodicLoop(Time first, Duration period, std::uint64_t catch_up_max = 25,
               Sleep sleep = sleep_until) noexcept
      : first_(first), period_(period), catch_up_max_(catch_up_max), sleep_(sleep) {}

  // Waits for the nominal time of the next tick. Returns nothing if the system does not sleep, so
  // that the loop would run faster than its period; the caller must stop.
  [[nodiscard]] std::optional<Tick> next() noexcept;

  // Ticks that started after the next one was due, and ticks that never ran; since the start.
  [[nodiscard]] std::uint64_t late() const noexcept { return late_; }
  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }

 private:
  Time first_;
  Duration period_;
  std::uint64_t catch_up_max_;
  Sleep sleep_;
  std::uint64_t next_number_ = 0;
  std::uint64_t late_ = 0;
  std::uint64_t skipped_ = 0;
};

}  // namespace glint
