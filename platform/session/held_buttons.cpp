#include "platform/session/held_buttons.hpp"

namespace glint {
namespace {

// The bit that says it; 0: none does.
std::uint8_t bit_of(Button button) noexcept {
  return static_cast<std::uint8_t>((1U << static_cast<unsigned>(button)) & k_buttons_mask);
}
static_assert(static_cast<int>(Button::draw) == 0 && static_cast<int>(Button::delete_last) == 1 &&
                  static_cast<int>(Button::undo) == 2,
              "PoseSample::buttons says them in this order");

}  // namespace

void HeldButtons::take(const ButtonEvent& event, RecorderLane* lane) noexcept {
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

}  // namespace glint
