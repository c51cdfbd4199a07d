// Button events in a run's recording and in the outputs of its ticks, from any source.
#include <gtest/gtest.h>

#include <array>
#include <latch>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "platform/cells/cell.hpp"
#include "platform/runtime/session/sinks.hpp"
#include "platform/sinks/record/recording_reader.hpp"
#include "tests/unit/platform/runtime/session/buttons_on_the_bus.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"
#include "tests/unit/platform/runtime/session/unseen_pen.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint {
namespace {

Cell recording_cell() {
  Cell cell = default_cell();
  cell.dds.on = false;
  return cell;
}

// Of a thread; after the last event its button is held.
const int k_events = test::repetitions(50001, 10001);

// Each thread presses and releases its own button alternately.
void offer_from_three_threads(Sinks& sinks) {
  std::array<std::thread, 3> threads;
  std::latch together(3);
  for (std::size_t t = 0; t < threads.size(); ++t) {
    threads[t] = std::thread([&sinks, &together, t] {
      together.arrive_and_wait();
      for (int i = 0; i < k_events; ++i) {
        sinks.offer_button({{i}, static_cast<Button>(t), i % 2 == 0});
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

TEST(ButtonsOfARun, AreAllRecordedThoughSeveralThreadsSayThem) {
  const TemporaryFolder folder;
  SinkOutcome outcome;
  Cell cell = recording_cell();
  cell.realtime = false;  // offers wait while the queue is full
  Sinks sinks(cell, {folder.path(), false, {}}, 0);
  offer_from_three_threads(sinks);
  sinks.close(outcome);
  EXPECT_TRUE(outcome.recording.complete());
  RecordingReader reader(outcome.recording_file);
  std::array<int, k_button_count> next{};
  while (const auto message = reader.next()) {
    const auto* const event = std::get_if<ButtonEvent>(&*message);
    if (event == nullptr) continue;
    int& i = next.at(static_cast<std::size_t>(event->button));
    EXPECT_EQ(event->time, Time{i});
    EXPECT_EQ(event->pressed, i % 2 == 0);
    ++i;
  }
  EXPECT_EQ(next, (std::array<int, k_button_count>{k_events, k_events, k_events, 0}));
}

// Each record of held buttons directly follows the event that caused it and matches it.
TEST(ButtonsOfARun, AreHeldAsTheirEventsSayThoughSeveralThreadsSayThem) {
  const TemporaryFolder folder;
  SinkOutcome outcome;
  Cell cell = recording_cell();
  cell.realtime = false;
  Sinks sinks(cell, {folder.path(), false, {}}, 0);
  offer_from_three_threads(sinks);
  ASSERT_TRUE(sinks.held_buttons().sample());
  EXPECT_EQ(sinks.held_buttons().value().held, 7);
  EXPECT_EQ(sinks.held_buttons().version(), 3 * static_cast<std::uint64_t>(k_events));
  sinks.close(outcome);
  ASSERT_TRUE(outcome.recording.complete());
  RecordingReader reader(outcome.recording_file);
  PenButtonsRecord expected;
  int changes = 0;
  while (const auto message = reader.next()) {
    if (const auto* const event = std::get_if<ButtonEvent>(&*message)) {
      const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(event->button));
      expected = {expected.version + 1, event->time,
                  static_cast<std::uint8_t>(expected.held ^ bit)};
    } else if (const auto* const held = std::get_if<PenButtonsRecord>(&*message)) {
      ++changes;
      ASSERT_EQ(*held, expected) << "change " << changes;
    }
  }
  EXPECT_EQ(changes, 3 * k_events);
}

TEST(ButtonsOfARun, AreHeldFromTheirPressToTheirReleaseAndChangeNothingWhenSaidAgain) {
  const TemporaryFolder folder;
  Sinks sinks(recording_cell(), {folder.path(), false, {}}, 0);
  graph::TripleBuffer<PenButtons>& held = sinks.held_buttons();
  std::int64_t time = 0;
  // Returns the held buttons after the event, or -1 if they did not change.
  const auto after = [&](Button button, bool pressed) {
    sinks.offer_button({{++time}, button, pressed});
    if (!held.sample()) return -1;
    EXPECT_EQ(held.time_ns(), time);
    return int{held.value().held};
  };
  EXPECT_EQ(held.version(), 0u);
  EXPECT_EQ(held.value().held, 0);
  EXPECT_EQ(after(Button::undo, false), -1) << "it was not held";
  EXPECT_EQ(after(Button::draw, true), 1);
  EXPECT_EQ(held.version(), 1u);
  EXPECT_EQ(after(Button::draw, true), -1);
  EXPECT_EQ(after(Button::delete_last, true), 3);
  EXPECT_EQ(after(Button::undo, true), 7);
  EXPECT_EQ(after(Button::finish, true), -1) << "three bits";
  EXPECT_EQ(after(Button::draw, false), 6);
  EXPECT_EQ(after(Button::finish, false), -1);
  EXPECT_EQ(after(Button::undo, false), 2);
  EXPECT_EQ(after(Button::delete_last, false), 0);
  EXPECT_EQ(held.version(), 6u);
  SinkOutcome outcome;
  sinks.close(outcome);
}

TEST(ButtonsOfARun, LeaveInTheirBitsOfEveryTickWithoutAPoseToo) {
  for (const bool fd : {false, true}) {
    const TemporaryFolder folder;
    Cell cell = recording_cell();
    cell.realtime = false;
    cell.can.format = fd ? CanFormat::fd : CanFormat::classic;
    Sinks sinks(cell, {folder.path(), false, {}}, 0);
    TickSinks tick_sinks;
    tick_sinks.can = sinks.can();
    TickGroupWithoutFrames pen(cell, sinks, tick_sinks);
    pen.tick();
    for (const auto& [button, pressed] :
         {std::pair{Button::draw, true}, std::pair{Button::undo, true},
          std::pair{Button::draw, false}, std::pair{Button::delete_last, true},
          std::pair{Button::undo, false}}) {
      sinks.offer_button({pen.now(), button, pressed});
      pen.tick();
    }
    for (const bool pressed : {true, false}) sinks.offer_button({pen.now(), Button::draw, pressed});
    pen.tick();
    SinkOutcome outcome;
    sinks.close(outcome);
    EXPECT_EQ(buttons_on_the_bus(folder.path() + "/can.log", fd),
              (std::vector<int>{0, 1, 5, 4, 6, 2, 2}))
        << (fd ? "CAN FD" : "classic");
  }
}

TEST(ButtonsOfARun, AreSaidNotToBeHeardWhereNoBusCanBringThem) {
  const TemporaryFolder folder;
  Cell cell = recording_cell();
  const auto why_not = [&] {
    SinkOutcome outcome;
    Sinks sinks(cell, {folder.path(), false, {}}, 0);
    sinks.close(outcome);
    return outcome.can_receive_error;
  };
  EXPECT_EQ(why_not(), "");
  cell.can.buttons = 0x190;
  EXPECT_EQ(why_not(), "can.buttons: log:can.log is not a bus; expected socketcan:IF in real time");
  cell.realtime = false;
  EXPECT_EQ(why_not(), "can.buttons: not in real time; expected socketcan:IF in real time");
}

}  // namespace
}  // namespace glint
