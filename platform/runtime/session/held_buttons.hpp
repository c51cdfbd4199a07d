// State of the pen's buttons for the tick group; each change is a new version.
//
// A tick reads the newest version only. A button that is pressed and released between two ticks is
// therefore in no tick; by key this is so for all buttons but draw. The output states which buttons
// are held. To count clicks, read the events (rt/glint/button, or /glint/button in a recording).
#pragma once

#include <cstdint>

#include "graph/latest.hpp"
#include "nodes/tokens.hpp"
#include "platform/sinks/record/button_event.hpp"
#include "platform/sinks/record/recorder.hpp"

namespace glint {

// Bit of a button in the set of held buttons; 0: it has none.
[[nodiscard]] inline std::uint8_t bit_of(Button button) noexcept {
  return static_cast<std::uint8_t>((1U << static_cast<unsigned>(button)) & k_buttons_mask);
}
static_assert(static_cast<int>(Button::draw) == 0 && static_cast<int>(Button::delete_last) == 1 &&
                  static_cast<int>(Button::undo) == 2,
              "PoseSample::buttons has this order");

class HeldButtons {
 public:
  // Call from one thread at a time. The last event of a button counts. `lane` may be null.
  void apply(const ButtonEvent& event, RecorderLane* lane) noexcept {
    const std::uint8_t bit = bit_of(event.button);
    const auto held = static_cast<std::uint8_t>(event.pressed ? now_.held | bit : now_.held & ~bit);
    if (held == now_.held) return;
    now_.held = held;
    ++version_;
    // Records the version before publishing it, so that its record precedes those of the ticks that
    // read it.
    if (lane != nullptr) (void)lane->offer_pen_buttons({version_, event.time, held});
    published_.write_slot() = now_;
    published_.publish(version_, event.time.nanoseconds);
  }

  [[nodiscard]] graph::TripleBuffer<PenButtons>& published() noexcept { return published_; }

 private:
  PenButtons now_;
  std::uint64_t version_ = 0;  // the first: no button was ever held
  graph::TripleBuffer<PenButtons> published_;
};

}  // namespace glint
