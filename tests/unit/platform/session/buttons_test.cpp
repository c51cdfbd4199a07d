// Buttons into a run's recording, whoever says them.
#include <gtest/gtest.h>

#include <array>
#include <latch>
#include <thread>
#include <variant>

#include "platform/cells/cell.hpp"
#include "platform/record/recording_reader.hpp"
#include "platform/session/sinks.hpp"
#include "tests/unit/platform/session/short_run.hpp"

namespace glint {
namespace {

Cell cell_that_records() {
  Cell cell = default_cell();
  cell.dds.on = false;
  return cell;
}

TEST(ButtonsOfARun, AreAllRecordedThoughSeveralThreadsSayThem) {
  constexpr int k_events = 50000;
  const TemporaryFolder folder;
  SinkOutcome outcome;
  Cell cell = cell_that_records();
  cell.realtime = false;  // a full queue is waited for
  Sinks sinks(cell, {folder.path(), false, {}}, 0);
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

TEST(ButtonsOfARun, AreSaidNotToBeHeardWhereNoBusCanBringThem) {
  const TemporaryFolder folder;
  Cell cell = cell_that_records();
  const auto why_not = [&] {
    SinkOutcome outcome;
    Sinks sinks(cell, {folder.path(), false, {}}, 0);
    sinks.close(outcome);
    return outcome.can_not_heard;
  };
  EXPECT_EQ(why_not(), "");
  cell.can.buttons = 0x190;
  EXPECT_EQ(why_not(), "can.buttons: log:can.log is no bus; expected socketcan:IF in real time");
  cell.realtime = false;
  EXPECT_EQ(why_not(), "can.buttons: not in real time; expected socketcan:IF in real time");
}

}  // namespace
}  // namespace glint
