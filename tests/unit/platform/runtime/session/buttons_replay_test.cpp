// Buttons pressed during a run: the replay of its recording reproduces the outputs.
#include <vector>

#include "platform/runtime/session/replay.hpp"
#include "tests/unit/platform/runtime/session/buttons_on_the_bus.hpp"
#include "tests/unit/platform/runtime/session/overrun_log.hpp"
#include "tests/unit/platform/runtime/session/run_with_buttons.hpp"
#include "tests/unit/platform/runtime/session/same_bytes.hpp"
#include "tests/unit/text_of.hpp"

namespace glint {
namespace {

// Draw is held while undo is pressed and released. delete_last is pressed and released between two
// ticks, so no tick samples it. finish has no bit. Undo is released at a late tick.
constexpr std::uint32_t k_late = 175;
std::vector<ButtonEvent> pressed_on_the_way() {
  const auto at = [](std::int64_t ms) { return Time{} + milliseconds(ms); };
  return {{at(302), Button::draw, true},         {at(501), Button::delete_last, true},
          {at(502), Button::delete_last, false}, {at(600), Button::undo, true},
          {at(650), Button::finish, true},       {at(700), Button::undo, false},
          {at(801), Button::draw, false}};
}
int held_at(std::uint32_t tick) {
  const std::int64_t ms = 4 * std::int64_t{tick};
  return (ms >= 302 && ms < 801 ? 1 : 0) + (ms >= 600 && ms < 700 ? 4 : 0);
}

Cell pressed_cell(const char* level) {
  Cell cell = short_cell(1.0, level);
  cell.overrun.tick = graph::OverrunPolicy::hold_last;
  return cell;
}

SessionResult pressed_run(const Cell& cell, const std::string& folder) {
  SessionOptions options;
  options.out = folder;
  options.injections = {{"", 1, true, k_late, cell.deadlines.tick + Duration{1}}};
  return run_with_buttons(cell, pressed_on_the_way(), options);
}

class ButtonsReplay : public testing::TestWithParam<const char*> {};

TEST_P(ButtonsReplay, GivesTheBytesOfARunInWhichTheyWerePressed) {
  const TemporaryFolder folder;
  const SessionResult run = pressed_run(pressed_cell(GetParam()), folder.path());
  ASSERT_TRUE(run.recording.complete());
  ASSERT_EQ(run.tick_overruns.missed, 1u);
  for (const int workers : {1, 2}) expect_same_bytes(run.recording_file, run, workers);

  OverrunLog log;
  Duration unix_offset;
  read_recording(run.recording_file, log, unix_offset);
  ASSERT_EQ(log.outputs.at(k_late).reason, Reason::overrun_held);
  const std::vector<int> on_the_bus = buttons_on_the_bus(folder.path() + "/can.log", false);
  ASSERT_EQ(on_the_bus.size(), log.outputs.size());
  auto on_this_tick = on_the_bus.begin();
  for (const auto& [tick, sample] : log.outputs) {
    EXPECT_EQ(sample.buttons, held_at(tick)) << "tick " << tick;
    EXPECT_EQ(*on_this_tick++, held_at(tick)) << "tick " << tick;
  }
}

TEST_P(ButtonsReplay, SendsTheSameCanFramesWhateverIsRecorded) {
  const TemporaryFolder one, other;
  const SessionResult run = pressed_run(pressed_cell(GetParam()), one.path());
  Cell unrecorded = pressed_cell("outputs");
  unrecorded.record.file.clear();
  EXPECT_EQ(pressed_run(unrecorded, other.path()).output_sha256, run.output_sha256);
  EXPECT_EQ(text_of(one.path() + "/can.log"), text_of(other.path() + "/can.log"));
}

INSTANTIATE_TEST_SUITE_P(AtEveryLevel, ButtonsReplay,
                         testing::Values("full", "roi", "blobs", "outputs"),
                         [](const auto& level) { return std::string(level.param); });

TEST(ButtonsReplay, HoldsNoneWhereAnOlderRecordingSaysNothingOfThem) {
  const TemporaryFolder folder;
  const SessionResult run = short_run(short_cell(0.5, "blobs"), folder.path());
  const std::string older = folder.path() + "/older.mcap";
  rewrite(run.recording_file, older, [](std::vector<RecordedMessage>& messages) {
    for (RecordedMessage& message : messages) {
      auto* const choice = std::get_if<ChoiceRecord>(&message);
      if (choice == nullptr || choice->group != k_tick_group) continue;
      EXPECT_EQ(choice->version_count, 3);
      choice->version_count = 2;
    }
  });
  expect_same_bytes(older, run);
}

TEST(ButtonsReplay, MissesAVersionThatTicksReadAndTheRecordingLacks) {
  const TemporaryFolder folder;
  const SessionResult run = pressed_run(pressed_cell("blobs"), folder.path());
  const std::string without = folder.path() + "/without.mcap";
  rewrite(run.recording_file, without, [](std::vector<RecordedMessage>& messages) {
    std::erase_if(messages, [](const RecordedMessage& message) {
      return std::holds_alternative<PenButtonsRecord>(message);
    });
  });
  const ReplayResult result = replay(without, {});
  EXPECT_FALSE(result.agrees());
  EXPECT_EQ(result.versions_missing, run.ticks - 76) << "from the first press on";
}

}  // namespace
}  // namespace glint
