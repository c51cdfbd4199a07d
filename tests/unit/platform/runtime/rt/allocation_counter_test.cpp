#include "platform/runtime/rt/allocation_counter.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#include "platform/runtime/rt/worker_pool.hpp"
#include "tests/unit/graph/small_graph.hpp"

namespace glint::test {
namespace {

// Volatile, so that the compiler keeps an allocation whose block is not used.
void* volatile g_block = nullptr;

template <class F>
std::uint64_t allocations_in(F f) {
  const std::uint64_t before = AllocationCounter::count();
  AllocationCounter::arm();
  f();
  AllocationCounter::disarm();
  return AllocationCounter::count() - before;
}

class Allocations : public testing::Test {
 protected:
  void SetUp() override {
    if (!AllocationCounter::available()) GTEST_SKIP() << "a sanitizer owns malloc";
  }
};

TEST_F(Allocations, OfTheMallocFamilyAreCounted) {
  EXPECT_EQ(allocations_in([] {
              g_block = std::malloc(10);
              std::free(g_block);
            }),
            1u);
  EXPECT_EQ(allocations_in([] {
              g_block = std::calloc(3, 10);
              g_block = std::realloc(g_block, 1000);
              std::free(g_block);
            }),
            2u);
  EXPECT_EQ(allocations_in([] {
              g_block = std::aligned_alloc(64, 128);
              std::free(g_block);
              void* block = nullptr;
              if (posix_memalign(&block, 64, 128) == 0) std::free(block);
            }),
            2u);
}

TEST_F(Allocations, OfNewAreCountedOnceEach) {
  struct alignas(128) Wide {
    char bytes[128];
  };
  EXPECT_EQ(allocations_in([] {
              g_block = ::operator new(10);
              ::operator delete(g_block);
            }),
            1u);
  EXPECT_EQ(allocations_in([] {
              Wide* const wide = new Wide;
              g_block = wide;
              delete wide;
            }),
            1u);
  EXPECT_EQ(allocations_in([] {
              std::vector<int> numbers(1000);
              g_block = numbers.data();
            }),
            1u);
}

TEST_F(Allocations, OfThreadsThatAreNotArmedAreNotCounted) {
  EXPECT_EQ(allocations_in([] {}), 0u);
  g_block = std::malloc(10);
  std::free(g_block);
  Release release, done;
  std::jthread other([&] {
    release.wait();
    g_block = std::malloc(10);
    std::free(g_block);
    done.post();
  });
  EXPECT_EQ(allocations_in([&] {
              release.post();
              done.wait();
            }),
            0u);
}

TEST_F(Allocations, OfPoolThreadsAreCounted) {
  WorkerPool pool({{"worker"}});
  Release done;
  EXPECT_EQ(allocations_in([&] {
              pool.release(
                  [](void* finished, int) noexcept {
                    g_block = std::malloc(10);
                    std::free(g_block);
                    static_cast<Release*>(finished)->post();
                  },
                  &done);
              done.wait();
            }),
            1u);
}

TEST_F(Allocations, AreNoneInTenThousandActivationsByOneThread) {
  const auto graph = std::make_unique<SmallGraph>();
  EXPECT_EQ(allocations_in([&] {
              for (int i = 0; i < 10'000; ++i) graph->activate();
            }),
            0u);
  EXPECT_EQ(graph->output<Total>().activations, 10'000);
}

TEST_F(Allocations, AreNoneInTenThousandActivationsByTwoWorkers) {
  const auto graph = std::make_unique<SmallGraph>();
  ParallelExecutor<2> two({{"worker"}}, 1000);
  EXPECT_EQ(allocations_in([&] {
              for (int i = 0; i < 10'000; ++i) graph->activate(two);
            }),
            0u);
  EXPECT_EQ(graph->output<Total>().activations, 10'000);
}

}  // namespace
}  // namespace glint::test
