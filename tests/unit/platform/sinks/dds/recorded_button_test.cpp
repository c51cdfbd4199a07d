// End to end: from a button's topic into the recording that `glint path` reads.
#include <gtest/gtest.h>

#include <string>
#include <variant>
#include <vector>

#include "platform/cells/cell.hpp"
#include "platform/runtime/session/sinks.hpp"
#include "platform/runtime/session/tool_roster.hpp"
#include "platform/sinks/record/recording_reader.hpp"
#include "tests/unit/platform/sinks/dds/diagnostic_entry.hpp"
#include "tests/unit/platform/sinks/dds/inputs.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/peer.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"

namespace glint {
namespace {

using RecordedButton = DdsTest;

TEST_F(RecordedButton, StandsInARunsRecordingAtItsTime) {
  const TemporaryFolder folder;
  Cell cell = default_cell();
  cell.dds.allow.add(DdsInput::buttons);
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
  cell.dds.allow.add(DdsInput::tools);
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

// Every input that a run reads, in the order of DdsInput; the default cell allows none.
TEST_F(RecordedButton, AParticipantWithoutAccessChangesNothingAndIsNamed) {
  const TemporaryFolder folder;
  SinkOptions options;
  options.out = folder.file("");
  options.with_reader = false;
  const Cell cell = default_cell();
  Sinks sinks(cell, options, k_clock_start.nanoseconds);
  ToolRoster roster(cell, &sinks.tool_requests());
  (void)roster.published().sample();
  Peer peer(test_settings());
  const dds_entity_t diagnostics = peer.reader(diagnostics_type(), k_diagnostics_topic,
                                               Reliability::reliable, Durability::volatile_data, 1);
  ASSERT_TRUE(wait_until([&] { return has_writer(diagnostics); }));
  const auto send = [&](DdsInput input, const TopicType& type, const std::string& topic,
                        const auto& message) {
    const dds_entity_t writer =
        peer.writer(type, topic, Reliability::reliable, Durability::transient_local, 64);
    // Repeated: a reader discovers the writer at a time of its own.
    const auto refused = [&] {
      return sinks.inputs()->counts().refusals.not_allowed[index_of(input)];
    };
    const std::uint64_t before = refused();
    ASSERT_TRUE(wait_until([&] {
      dds_write(writer, &message);
      return refused() > before;
    })) << topic;
  };
  JointText joints({"elbow"}, {1});
  send(DdsInput::joint_states, joint_state_type(), "rt/joint_states", joints.message());
  std::string text = "<robot/>", name = cell.tools.items[0].name.data(), frame = "hmd_world";
  send(DdsInput::robot_description, text_type(), "rt/robot_description", TextMessage{text.data()});
  send(DdsInput::initial_pose, pose_covariance_type(), "rt/initialpose", guess_message(frame));
  for (const char* button : {"button", "button_delete", "button_undo", "button_finish"}) {
    send(DdsInput::buttons, bool_type(), topic_under("glint", button), BoolMessage{true});
  }
  for (const char* change : {"tool_add", "tool_remove"}) {
    send(DdsInput::tools, text_type(), topic_under("glint", change), TextMessage{name.data()});
  }
  sinks.inputs()->stop();
  const ReceivedCounts counts = sinks.inputs()->counts();
  for (std::size_t i = 0; i < k_dds_inputs; ++i) {
    EXPECT_GT(counts.refusals.not_allowed[i], 0u) << k_dds_input_names[i];
  }
  EXPECT_EQ(counts.joints + counts.descriptions + counts.guesses + counts.buttons + counts.tools,
            0u);
  EXPECT_FALSE(sinks.inputs()->joints().sample());
  EXPECT_FALSE(sinks.inputs()->description().sample());
  EXPECT_FALSE(sinks.inputs()->initial_pose().sample());
  EXPECT_FALSE(sinks.held_buttons().sample());
  roster.apply_changes(Time{1});
  EXPECT_FALSE(roster.published().sample()) << "no other set of tools";
  const std::string expected = text_of(counts.refusals);
  EXPECT_TRUE(wait_until([&] {
    std::string found;
    (void)take<DiagnosticsMessage>(diagnostics, 1, [&](const DiagnosticsMessage& message) {
      found = entry_of(message, "glint: inputs").message;
    });
    return found == expected;
  }));
  SinkOutcome outcome;
  sinks.close(outcome);
  EXPECT_EQ(text_of(outcome.dds_received.refusals), expected);
  RecordingReader reader(outcome.recording_file);
  int events = 0;
  while (const auto message = reader.next()) {
    events += std::holds_alternative<ButtonEvent>(*message) ? 1 : 0;
  }
  EXPECT_EQ(events, 0);
}

}  // namespace
}  // namespace glint
