// Ticks at a fixed rate: tick n is due at first + n * period, always. Late ticks are made up for,
// one at once after the other; what is later than that is skipped, and said to be.
#pragma once

#include <cstdint>

#include "kernels/units.hpp"

namespace glint {

struct Tick {
  std::uint32_t number = 0;
  Time nominal;               // first + number * period: what the output may know of time
  Time woken;                 // when it really began
  std::uint32_t skipped = 0;  // ticks between this one and the one before that never ran
};

class PeriodicLoop {
 public:
  // period > 0. `catch_up_max` is how many ticks may be owed before they are skipped.
  PeriodicLoop(Time first, Duration period, std::uint32_t catch_up_max = 25) noexcept
      : first_(first), period_(period), catch_up_max_(catch_up_max) {}

  // Waits for the next tick, at most until its nominal time.
  [[nodiscard]] Tick next() noexcept;

  // Ticks that began after the next one was due, and ticks that never ran; since the start.
  [[nodiscard]] std::uint64_t late() const noexcept { return late_; }
  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }

 private:
  Time first_;
  Duration period_;
  std::uint32_t catch_up_max_;
  std::uint32_t next_number_ = 0;
  std::uint64_t late_ = 0;
  std::uint64_t skipped_ = 0;
};

}  // namespace glint
