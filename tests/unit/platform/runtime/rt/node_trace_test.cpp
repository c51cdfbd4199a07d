#include "platform/runtime/rt/node_trace.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "platform/runtime/rt/page_faults.hpp"
#include "platform/runtime/rt/trace_writer.hpp"

namespace glint {
namespace {

TEST(NodeTrace, KeepsWhenEachNodeRanAndWhatWasDecidedAfterIt) {
  const auto ring = std::make_unique<SpanRing>();
  constexpr std::array<std::int64_t, 2> bounds = {100, 200};
  NodeTrace trace(*ring, 1, 2, bounds);
  const Time begin = monotonic_now();
  trace.begin_activation(7, 70, 1'000, cycle_count());
  trace.on_node_begin(0);
  (void)sleep_until(monotonic_now() + milliseconds(2));
  trace.on_node_end(0);
  trace.on_node_begin(1);
  trace.on_node_end(1);
  trace.set_flag(k_span_overran);
  trace.end_activation();
  const std::int64_t all_ns = (monotonic_now() - begin).nanoseconds;
  TraceSpan first, second, none;
  ASSERT_TRUE(ring->pop(first));
  ASSERT_TRUE(ring->pop(second));
  EXPECT_FALSE(ring->pop(none));
  EXPECT_EQ(first.activation, 7u);
  EXPECT_EQ(first.frame_sequence, 70u);
  EXPECT_EQ(first.group, 1);
  EXPECT_EQ(first.worker, 2);
  EXPECT_EQ(first.bound_ns, 100);
  EXPECT_EQ(first.flags, 0);
  EXPECT_GE(first.begin_ns, 1'000);
  EXPECT_GE(first.end_ns - first.begin_ns, 1'900'000) << "slept 2 ms";
  EXPECT_LE(second.end_ns, 1'000 + all_ns + all_ns / 100);
  EXPECT_LE(first.end_ns, second.begin_ns);
  EXPECT_EQ(second.node, 1);
  EXPECT_EQ(second.bound_ns, 200);
  EXPECT_EQ(second.flags, k_span_overran);
}

TEST(TraceWriter, WritesItsHeaderAndEverySpanOfEveryRing) {
  std::string pattern = (std::filesystem::temp_directory_path() / "glint-XXXXXX").string();
  const std::string folder = mkdtemp(pattern.data());
  const std::string path = folder + "/trace.spans";
  TraceWriter writer(path, "{}");
  SpanRing& one = writer.add_ring();
  SpanRing& two = writer.add_ring();
  writer.start();
  TraceSpan span;
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE((i % 2 == 0 ? one : two).push(span));
  }
  EXPECT_EQ(writer.close(), "");
  EXPECT_EQ(writer.written(), 100u);
  EXPECT_EQ(std::filesystem::file_size(path), 3u + 100 * sizeof(TraceSpan));
  std::filesystem::remove_all(folder);
}

TEST(PageFaults, OfAnArmedThreadAreCounted) {
  constexpr std::size_t k_pages = 64;
  munlockall();  // an earlier test in this process locked memory, which maps pages at once
  const std::uint64_t before = PageFaultCounter::count();
  void* const fresh =
      mmap(nullptr, k_pages * 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(fresh, MAP_FAILED);
  PageFaultCounter::arm();
  for (std::size_t i = 0; i < k_pages; ++i) static_cast<volatile char*>(fresh)[i * 4096] = 1;
  PageFaultCounter::disarm();
  const std::uint64_t touched = PageFaultCounter::count() - before;
  EXPECT_GE(touched, 1u) << "memory that was never there before";
  PageFaultCounter::arm();
  for (std::size_t i = 0; i < k_pages; ++i) static_cast<volatile char*>(fresh)[i * 4096] = 2;
  PageFaultCounter::disarm();
  EXPECT_LT(PageFaultCounter::count() - before - touched, touched);
  munmap(fresh, k_pages * 4096);
}

}  // namespace
}  // namespace glint
