// offer() runs on the tick thread and must not allocate.
#include "platform/sinks/dds/dds_sink.hpp"
#include "tests/unit/heap_count.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"

namespace glint {
namespace {

using Offers = DdsTest;

TEST_F(Offers, AllocateNothingWhetherTheRingIsFullOrNot) {
  DdsSink sink(test_settings());
  sink.start();
  {
    const HeapCount heap;
    for (std::uint32_t i = 0; i < 10'000; ++i) sink.offer(sample_at(i));
    EXPECT_EQ(heap.count(), 0u);
  }
  sink.stop();
  const DdsCounts counts = sink.counts();
  EXPECT_EQ(counts.offered, 10'000u);
  EXPECT_EQ(counts.offered, counts.written + counts.ring_dropped);
}

}  // namespace
}  // namespace glint
