// offer() is called by the tick thread: it must never reach the heap.
#include <cstdlib>
#include <new>

#include "platform/dds/dds_sink.hpp"
#include "tests/unit/platform/dds/isolated_network.hpp"
#include "tests/unit/platform/dds/samples.hpp"

namespace {
thread_local bool counting = false;
thread_local int allocations = 0;
}  // namespace

void* operator new(std::size_t size) {
  if (counting) ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace glint {
namespace {

using Offers = DdsTest;

TEST_F(Offers, AllocateNothingWhetherTheRingIsFullOrNot) {
  DdsSink sink(test_settings());
  sink.start();
  counting = true;
  for (std::uint32_t i = 0; i < 10'000; ++i) sink.offer(sample_at(i));
  counting = false;
  EXPECT_EQ(allocations, 0);
  counting = true;
  ::operator delete(::operator new(1));
  counting = false;
  EXPECT_EQ(allocations, 1) << "the count is armed";
  sink.stop();
  const DdsCounts counts = sink.counts();
  EXPECT_EQ(counts.offered, 10'000u);
  EXPECT_EQ(counts.offered, counts.written + counts.ring_dropped);
}

}  // namespace
}  // namespace glint
