// Loop of ticks that frames' estimates release as well (tick_releases.hpp).
//
// Ticks are numbered without gaps, so that an E2E counter skips no set. A tick that is a period
// late or more is the only one: those before it are skipped and counted, since their sets would
// follow each other too fast for a controller.
#pragma once

#include <cstdint>
#include <optional>

#include "platform/runtime/rt/clock.hpp"
#include "platform/runtime/rt/periodic_loop.hpp"
#include "platform/runtime/session/tick_releases.hpp"

namespace glint {

class EstimateLoop {
 public:
  // `estimates` must outlive this object; their times count from `epoch` (monotonic).
  EstimateLoop(const Cell& cell, Time epoch, MeasuredEstimates& estimates) noexcept
      : releases_(cell), period_(tick_period_of(cell)), epoch_(epoch), estimates_(&estimates) {}

  // Waits for the next release. Returns nothing if the system does not sleep, as PeriodicLoop does.
  [[nodiscard]] std::optional<Tick> next() noexcept {
    MeasuredEstimate newest = estimates_->newest();
    Time due = releases_.next(newest), now = session_now();
    while (now < due) {
      const bool released = estimates_->wait_until(epoch_ + (due - Time{}));
      now = session_now();
      if (!released && now < due) return std::nullopt;
      newest = estimates_->newest();
      due = releases_.next(newest);
    }
    Tick tick;
    tick.number = number_++;
    tick.skipped = static_cast<std::uint64_t>((now - due).nanoseconds / period_.nanoseconds);
    skipped_ += tick.skipped;
    due = due + period_ * static_cast<std::int64_t>(tick.skipped);
    releases_.released(due, newest);
    tick.nominal = epoch_ + (due - Time{});
    tick.woken = epoch_ + (now - Time{});
    return tick;
  }

  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }

 private:
  [[nodiscard]] Time session_now() const noexcept { return Time{} + (monotonic_now() - epoch_); }

  TickReleases releases_;
  Duration period_;
  Time epoch_;
  MeasuredEstimates* estimates_;
  std::uint64_t number_ = 0, skipped_ = 0;
};

}  // namespace glint
