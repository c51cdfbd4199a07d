// Keyboard keys as the pen's buttons.
#include "platform/tools/programming/key_buttons.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace glint {
namespace {

std::vector<ButtonEvent> events_of(const std::vector<std::pair<char, Duration>>& keys) {
  std::vector<ButtonEvent> events;
  KeyButtons buttons([&](const ButtonEvent& event) { events.push_back(event); });
  for (const auto& [key, since_start] : keys) buttons.press(key, Time{} + since_start);
  return events;
}

Time at(std::int64_t ms) { return Time{} + milliseconds(ms); }

TEST(KeyButtons, SwitchDrawBySpace) {
  const std::vector<ButtonEvent> expected{{at(1000), Button::draw, true},
                                          {at(1200), Button::draw, false},
                                          {at(3000), Button::draw, true}};
  EXPECT_EQ(
      events_of({{' ', milliseconds(1000)}, {' ', milliseconds(1200)}, {' ', milliseconds(3000)}}),
      expected);
}

TEST(KeyButtons, PressTheOthersOnce) {
  const std::vector<ButtonEvent> expected{
      {at(1), Button::delete_last, true}, {at(1), Button::delete_last, false},
      {at(2), Button::undo, true},        {at(2), Button::undo, false},
      {at(3), Button::finish, true},      {at(3), Button::finish, false}};
  EXPECT_EQ(events_of({{'d', milliseconds(1)}, {'u', milliseconds(2)}, {'f', milliseconds(3)}}),
            expected);
}

TEST(KeyButtons, DoNothingByAnyOtherKey) {
  for (int key = 0; key < 256; ++key) {
    if (std::string_view(" duf").find(static_cast<char>(key)) != std::string_view::npos) continue;
    EXPECT_TRUE(events_of({{static_cast<char>(key), milliseconds(1)}}).empty()) << key;
  }
}

// Keyboard autorepeat: after half a second, 25 times a second.
TEST(KeyButtons, TakeAKeysOwnRepetitionForNoPress) {
  std::vector<std::pair<char, Duration>> keys{{' ', milliseconds(0)}};
  for (int ms = 500; ms < 2000; ms += 40) keys.emplace_back(' ', milliseconds(ms));
  keys.emplace_back(' ', milliseconds(3000));
  const std::vector<ButtonEvent> expected{
      {at(0), Button::draw, true}, {at(500), Button::draw, false}, {at(3000), Button::draw, true}};
  EXPECT_EQ(events_of(keys), expected);
}

}  // namespace
}  // namespace glint
