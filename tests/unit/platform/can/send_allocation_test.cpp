// The tick thread sends: it may not ask for memory.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "platform/can/can_sink.hpp"
#include "tests/unit/platform/can/temporary_folder.hpp"

namespace {

thread_local bool counting = false;
thread_local int allocations = 0;

}  // namespace

void* operator new(std::size_t size) {
  if (counting) ++allocations;
  if (void* const memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace glint {
namespace {

TEST(LogSink, AsksForNoMemoryToSendAFrame) {
  const TemporaryFolder folder;
  CanSinkOptions options;
  options.directory = folder.path();
  options.log_interface = "a_name_too_long_for_small_strings";
  const auto sink = open_can_sink("log:can.log", options);
  counting = true;
  allocations = 0;
  const auto* volatile proof = new int(1);  // the counter counts
  delete proof;
  for (int i = 0; i < 30000; ++i) sink->send({}, {});  // into a full ring as well
  counting = false;
  EXPECT_EQ(allocations, 1);
  sink->flush();
  const CanSinkCounts counts = sink->counts();
  EXPECT_EQ(counts.sent + counts.dropped, 30000U);
}

}  // namespace
}  // namespace glint
