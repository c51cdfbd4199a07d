// Maps keys of a terminal to the pen's buttons.
//
//   space   draw: one press begins, the next ends; two presses within 0.3 s are a click: a waypoint
//   d u f   delete_last, undo, finish
// A terminal reports that a key went down, never that it came up. Therefore draw toggles, and the
// other buttons are released as they are pressed. A held key repeats 10 to 40 times a second,
// faster than a finger: of a repeated space only the first press counts.
#pragma once

#include <functional>
#include <optional>

#include "kernels/units.hpp"
#include "platform/sinks/record/button_event.hpp"

namespace glint {

inline constexpr Duration k_key_repeat_max = milliseconds(100);
inline constexpr const char* k_keys_text =
    "space draw (press to begin, again to end; twice within 0.3 s: a waypoint), d delete last, "
    "u undo, f finish";

class KeyButtons {
 public:
  using OnButton = std::function<void(const ButtonEvent&)>;

  explicit KeyButtons(OnButton on_button);

  // Requires rising times. Other keys do nothing.
  void press(char key, Time time);

 private:
  OnButton on_button_;
  bool drawing_ = false;
  std::optional<Time> last_space_;
};

}  // namespace glint
