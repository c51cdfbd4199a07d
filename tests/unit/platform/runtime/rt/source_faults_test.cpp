// Faults of a live source: events, and silence at ticks.
#include "platform/runtime/rt/source_faults.hpp"

#include <gtest/gtest.h>

namespace glint {
namespace {

Time at_ms(int ms) { return Time{} + milliseconds(ms); }

TEST(SourceFaultsTest, NotesASilenceOfOneAndAHalfGapsOnce) {
  SourceFaults faults(milliseconds(20));
  faults.check_silence(at_ms(500));
  EXPECT_EQ(faults.total(), 0u) << "before the first frame";
  faults.note_frame(at_ms(1000));
  faults.check_silence(at_ms(1030));
  EXPECT_EQ(faults.total(), 0u);
  for (const int ms : {1034, 1038, 1042}) faults.check_silence(at_ms(ms));
  EXPECT_EQ(faults.of(SourceFault::no_frame), 1u);
  EXPECT_TRUE(faults.silent());
  const auto events = faults.events(SourceFault::no_frame);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].time, at_ms(1034));
  EXPECT_EQ(events[0].frames, 1u);
  faults.note_frame(at_ms(1043));
  faults.check_silence(at_ms(1046));
  EXPECT_FALSE(faults.silent());
  faults.check_silence(at_ms(1074));
  EXPECT_EQ(faults.of(SourceFault::no_frame), 2u);
  faults.note_frame(at_ms(1080));
  faults.end();
  faults.check_silence(at_ms(1200));
  EXPECT_EQ(faults.of(SourceFault::no_frame), 2u) << "after the end";
}

TEST(SourceFaultsTest, CountsMoreFaultsThanItsEvents) {
  SourceFaults faults(milliseconds(20));
  for (int i = 0; i < 100; ++i) faults.note(SourceFault::stamp_refused, at_ms(i));
  EXPECT_EQ(faults.of(SourceFault::stamp_refused), 100u);
  EXPECT_EQ(faults.events(SourceFault::stamp_refused).size(), SourceFaults::k_events_max);
  EXPECT_EQ(faults.newest(), SourceFault::stamp_refused);
  EXPECT_TRUE(faults.events(SourceFault::connection_lost).empty());
}

}  // namespace
}  // namespace glint
