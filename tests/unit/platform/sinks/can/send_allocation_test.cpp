// Sending on the tick thread does not allocate.
#include <gtest/gtest.h>

#include "platform/sinks/can/can_sink.hpp"
#include "tests/unit/heap_count.hpp"
#include "tests/unit/platform/sinks/can/temporary_folder.hpp"

namespace glint::send_allocation_test {
namespace {

TEST(LogSink, AsksForNoMemoryToSendAFrame) {
  const TemporaryFolder folder;
  CanSinkOptions options;
  options.directory = folder.path();
  options.log_interface = "a_name_too_long_for_small_strings";
  const auto sink = open_can_sink("log:can.log", options);
  {
    const HeapCount heap;
    for (int i = 0; i < 30000; ++i) sink->send({}, {});  // into a full ring as well
    EXPECT_EQ(heap.count(), 0u);
  }
  sink->flush();
  const CanSinkCounts counts = sink->counts();
  EXPECT_EQ(counts.sent + counts.dropped, 30000U);
}

}  // namespace
}  // namespace glint::send_allocation_test
