// End to end: from a button's topic through a tick to the status that DDS readers receive.
#include <vector>

#include "platform/runtime/session/sinks.hpp"
#include "tests/unit/platform/runtime/session/unseen_pen.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/peer.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"

namespace glint {
namespace {

using ButtonStatus = DdsTest;

TEST_F(ButtonStatus, SaysWhatIsHeldFromTheNextTickOn) {
  const TemporaryFolder folder;
  Cell cell = default_cell();
  cell.dds.allow.add(DdsInput::buttons);
  SinkOptions options;
  options.out = folder.file("");
  options.with_reader = false;
  Sinks sinks(cell, options, k_clock_start.nanoseconds);
  Peer peer(test_settings());
  const dds_entity_t reader = peer.reader(status_type(), topics_of("glint", "pen").status,
                                          Reliability::reliable, Durability::volatile_data, 100);
  const dds_entity_t button = peer.writer(bool_type(), "rt/glint/button_undo",
                                          Reliability::reliable, Durability::volatile_data, 64);
  ASSERT_TRUE(peer.wait_for_discovery(*sinks.dds()));
  ASSERT_TRUE(wait_until([&] { return has_reader(button); }));

  TickSinks tick_sinks;
  tick_sinks.dds = sinks.dds();
  TickGroupWithoutFrames pen(cell, sinks, tick_sinks);
  pen.tick();
  for (const bool down : {true, false}) {
    const BoolMessage message{down};
    dds_write(button, &message);
    ASSERT_TRUE(wait_until([&] { return sinks.held_buttons().sample(); }));
    pen.tick();
    pen.tick();
  }
  std::vector<int> said;
  EXPECT_EQ(take<StatusMessage>(
                reader, 5, [&](const StatusMessage& message) { said.push_back(message.buttons); }),
            5u);
  EXPECT_EQ(said, (std::vector<int>{0, 4, 4, 0, 0}));
  SinkOutcome outcome;
  sinks.close(outcome);
}

}  // namespace
}  // namespace glint
