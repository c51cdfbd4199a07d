// Which of the pen's buttons are held, for the tick group: each change is a version of its own.
//
// A tick sees the newest version and no other. A button that goes down and up between two ticks,
// as those by key but draw do, therefore shows in none: what leaves says what is held, and who
// counts clicks has the events (rt/glint/button, /glint/button in a recording).
#pragma once

#include <cstdint>

#include "graph/latest.hpp"
#include "nodes/tokens.hpp"
#include "platform/record/button_event.hpp"
#include "platform/record/recorder.hpp"

namespace glint {

// A button's bit of what is held; 0: it has none.
[[nodiscard]] inline std::uint8_t bit_of(Button button) noexcept {
  return static_cast<std::uint8_t>((1U << static_cast<unsigned>(button)) & k_buttons_mask);
}
static_assert(static_cast<int>(Button::draw) == 0 && static_cast<int>(Button::delete_last) == 1 &&
                  static_cast<int>(Button::undo) == 2,
              "PoseSample::buttons says them in this order");

class HeldButtons {
 public:
  // One thread at a time. Whoever spoke last of a button counts. `lane` may be null.
  void take(const ButtonEvent& event, RecorderLane* lane) noexcept {
    const std::uint8_t bit = bit_of(event.button);
    const auto held = static_cast<std::uint8_t>(event.pressed ? now_.held | bit : now_.held & ~bit);
    if (held == now_.held) return;
    now_.held = held;
    ++version_;
    // Recorded first: what stands in front of a value stands in front of whoever read it.
    if (lane != nullptr) (void)lane->offer_pen_buttons({version_, event.time, held});
    published_.write_slot() = now_;
    published_.publish(version_, event.time.nanoseconds);
  }

  [[nodiscard]] graph::TripleBuffer<PenButtons>& published() noexcept { return published_; }

 private:
  PenButtons now_;
  std::uint64_t version_ = 0;  // the first is "none was ever held"
  graph::TripleBuffer<PenButtons> published_;
};

}  // namespace glint
