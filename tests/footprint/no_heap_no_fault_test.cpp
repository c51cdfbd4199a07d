// Ten thousand cycles of both groups allocate no memory and cause no page fault. A node that
// allocates once, or touches one new page, is detected.
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cstdlib>

#include "platform/runtime/rt/allocation_counter.hpp"
#include "platform/runtime/rt/memory_lock.hpp"
#include "platform/runtime/rt/worker_pool.hpp"
#include "tests/footprint/groups.hpp"
#include "tests/footprint/page_faults.hpp"

namespace glint::footprint {
namespace {

struct Seen {
  std::uint64_t allocations = 0;
  long faults = 0;
  int measured = 0;  // most tools measured after any cycle
};

// Warms up, then counts. `run(graph)` activates the graph.
template <class TickGraph, class Run>
Seen count_over(std::uint32_t cycles, Groups<TickGraph>& groups, Run run) {
  for (std::uint32_t i = 0; i < k_warm_up_cycles; ++i) groups.cycle(i, run);
  Seen seen;
  const std::uint64_t allocations = AllocationCounter::count();
  const long faults = page_faults();
  AllocationCounter::arm();
  for (std::uint32_t i = k_warm_up_cycles; i < k_warm_up_cycles + cycles; ++i) {
    groups.cycle(i, run);
    if (groups.measured_now() > seen.measured) seen.measured = groups.measured_now();
  }
  AllocationCounter::disarm();
  seen.faults = page_faults() - faults;
  seen.allocations = AllocationCounter::count() - allocations;
  return seen;
}

const auto activate_alone = [](auto& graph) { graph.activate(); };

struct Extra {
  const void* at = nullptr;
};

// The mutant misbehaves in the middle of a shorter run; later cycles are irrelevant.
constexpr std::uint32_t k_mutant_cycles = 1000;
constexpr std::uint32_t k_bad_tick = 5 * k_warm_up_cycles + 2345;

// Mutants: an additional node that misbehaves once.
struct AllocateOnce {
  void operator()(const Now& now, Extra& extra) noexcept {
    if (now.number == k_bad_tick) block_ = std::malloc(64);
    extra.at = block_;
  }
  ~AllocateOnce() { std::free(block_); }

 private:
  void* block_ = nullptr;
};
struct TouchOnePage {
  char* page = nullptr;
  void operator()(const Now& now, Extra& extra) const noexcept {
    if (now.number == k_bad_tick) *static_cast<volatile char*>(page) = 1;
    extra.at = page;
  }
};
template <class Mutant>
using Mutated =
    graph::Graph<graph::Inputs<Now, graph::Latest<Estimates>, graph::Latest<RobotFrame>,
                               graph::Latest<PenButtons>>,
                 graph::Outputs<PoseSamples, CanFrames, Extra>, PredictTools, PackCan, Mutant>;

class Cycles : public testing::Test {
 protected:
  void SetUp() override {
    if (!AllocationCounter::available()) GTEST_SKIP() << "a sanitizer owns malloc";
    (void)lock_memory();  // as a session does; if refused, a test still pages nothing out
  }
};

TEST_F(Cycles, TenThousandAskForNoMemoryAndFaultOnNoPageByOneThread) {
  Groups<> groups;
  const Seen seen = count_over(k_cycles, groups, activate_alone);
  EXPECT_EQ(seen.allocations, 0u);
  EXPECT_EQ(seen.faults, 0);
  EXPECT_EQ(seen.measured, k_tools_max) << "the whole crowd was never seen at once";
}

TEST_F(Cycles, TenThousandAskForNoMemoryAndFaultOnNoPageByTwoWorkers) {
  Groups<> groups;
  ParallelExecutor<2> two({{.name = "worker"}}, 100'000);
  const Seen seen = count_over(k_cycles, groups, [&two](auto& graph) { graph.activate(two); });
  EXPECT_EQ(seen.allocations, 0u);
  EXPECT_EQ(seen.faults, 0);
  EXPECT_EQ(seen.measured, k_tools_max) << "the whole crowd was never seen at once";
}

TEST_F(Cycles, BetrayANodeThatAllocatesOnce) {
  Groups<Mutated<AllocateOnce>> groups;
  EXPECT_EQ(count_over(k_mutant_cycles, groups, activate_alone).allocations, 1u);
}

TEST_F(Cycles, BetrayANodeThatTouchesOneNewPage) {
  Groups<Mutated<TouchOnePage>> groups;
  constexpr std::size_t size = 4096;
  void* const page =
      mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(page, MAP_FAILED);
  groups.tick().node<TouchOnePage>().page = static_cast<char*>(page);
  // Locking may include memory allocated later, so unlock this page only.
  ASSERT_EQ(munlock(page, size), 0);
  ASSERT_EQ(madvise(page, size, MADV_DONTNEED), 0);
  EXPECT_EQ(count_over(k_mutant_cycles, groups, activate_alone).faults, 1);
  munmap(page, size);
}

}  // namespace
}  // namespace glint::footprint
