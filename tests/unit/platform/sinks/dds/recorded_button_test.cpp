// End to end: from a button's topic into the recording that `glint path` reads.
#include <gtest/gtest.h>

#include <string>
#include <variant>
#include <vector>

#include "platform/cells/cell.hpp"
#include "platform/runtime/session/sinks.hpp"
#include "platform/runtime/session/tool_roster.hpp"
#include "platform/sinks/record/recording_reader.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/peer.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"

namespace glint {
namespace {

using RecordedButton = DdsTest;

TEST_F(RecordedButton, StandsInARunsRecordingAtItsTime) {
  const TemporaryFolder folder;
  const Cell cell = default_cell();
  SinkOptions options;
  options.out = folder.file("");
  options.with_reader = false;
  SinkOutcome outcome;
  Time before, after;
  {
    Sinks sinks(cell, options, k_clock_start.nanoseconds);
    Peer peer(test_settings());
    const dds_entity_t button = peer.writer(bool_type(), "rt/glint/button", Reliability::reliable,
                                            Durability::volatile_data, 64);
    ASSERT_TRUE(wait_until([&] { return has_reader(button); }));
    before = Time{dds_time()} - k_clock_start;
    for (const bool down : {true, false}) {
      const BoolMessage message{down};
      dds_write(button, &message);
    }
    EXPECT_TRUE(wait_until([&] { return sinks.inputs()->counts().buttons == 2; }));
    after = Time{dds_time()} - k_clock_start;
    sinks.close(outcome);
  }
  EXPECT_EQ(outcome.dds_received.buttons, 2u);
  EXPECT_TRUE(outcome.recording.complete());
  RecordingReader reader(outcome.recording_file);
  std::vector<ButtonEvent> events;
  while (const auto message = reader.next()) {
    if (const auto* event = std::get_if<ButtonEvent>(&*message)) events.push_back(*event);
  }
  ASSERT_EQ(events.size(), 2u);
  EXPECT_TRUE(events[0].pressed);
  EXPECT_FALSE(events[1].pressed);
  EXPECT_GE(events[0].time, before);
  EXPECT_LE(events[1].time, after);
}

TEST_F(RecordedButton, AToolNamedOverDdsReachesARunsRosterWhereTheCellAllowsIt) {
  const TemporaryFolder folder;
  Cell cell = default_cell();
  cell.dds.tool_changes = true;
  SinkOptions options;
  options.out = folder.file("");
  options.with_reader = false;
  Sinks sinks(cell, options, k_clock_start.nanoseconds);
  ToolRoster roster(cell, &sinks.tool_requests());
  Peer peer(test_settings());
  const dds_entity_t remove = peer.writer(text_type(), "rt/glint/tool_remove",
                                          Reliability::reliable, Durability::volatile_data, 64);
  ASSERT_TRUE(wait_until([&] { return has_reader(remove); }));
  std::string name = cell.tools.items[0].name.data();
  const TextMessage message{name.data()};
  dds_write(remove, &message);
  ASSERT_TRUE(wait_until([&] { return sinks.inputs()->counts().tools == 1; }));
  roster.apply_changes(Time{1});
  ASSERT_TRUE(roster.published().sample());
  EXPECT_FALSE(roster.published().value().items[0].present());
  SinkOutcome outcome;
  sinks.close(outcome);
  EXPECT_EQ(outcome.dds_received.tools, 1u);
  ASSERT_EQ(outcome.tool_change_counts.size(), 1u);
  EXPECT_EQ(outcome.tool_change_counts[0].removed, 1u);
  EXPECT_EQ(outcome.tool_change_counts[0].added, 0u);
}

// The sink creates the button readers after the tool readers. A peer that has discovered the last
// one has discovered all.
TEST_F(RecordedButton, NobodyReadsToolNamesUnlessTheCellAllowsIt) {
  const TemporaryFolder folder;
  SinkOptions options;
  options.out = folder.file("");
  options.with_reader = false;
  Sinks sinks(default_cell(), options, k_clock_start.nanoseconds);
  Peer peer(test_settings());
  const auto writer = [&](const TopicType& type, const char* topic) {
    return peer.writer(type, topic, Reliability::reliable, Durability::volatile_data, 64);
  };
  const dds_entity_t add = writer(text_type(), "rt/glint/tool_add");
  const dds_entity_t remove = writer(text_type(), "rt/glint/tool_remove");
  const dds_entity_t finish = writer(bool_type(), "rt/glint/button_finish");
  ASSERT_TRUE(wait_until([&] { return has_reader(finish); }));
  EXPECT_FALSE(has_reader(add));
  EXPECT_FALSE(has_reader(remove));
  SinkOutcome outcome;
  sinks.close(outcome);
}

}  // namespace
}  // namespace glint
