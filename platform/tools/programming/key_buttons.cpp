#include "platform/tools/programming/key_buttons.hpp"

#include <utility>

namespace glint {

KeyButtons::KeyButtons(OnButton on_button) : on_button_(std::move(on_button)) {}

void KeyButtons::press(char key, Time time) {
  const auto down_and_up = [&](Button button) {
    on_button_({time, button, true});
    on_button_({time, button, false});
  };
  if (key == 'd') down_and_up(Button::delete_last);
  if (key == 'u') down_and_up(Button::undo);
  if (key == 'f') down_and_up(Button::finish);
  if (key != ' ') return;
  const bool repeated = last_space_ && time - *last_space_ <= k_key_repeat_max;
  last_space_ = time;
  if (repeated) return;
  drawing_ = !drawing_;
  on_button_({time, Button::draw, drawing_});
}

}  // namespace glint
