#include "graph/workers.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "wide_graph.hpp"
#include "yielding_rest.hpp"

namespace glint::test::workers_test {
namespace {

// Runs each worker in a thread that lives for one activation: slow but simple.
template <int W>
struct Threads {
  YieldingRest rest;
  Workers<W, YieldingRest> workers{rest};
  template <class G>
  void execute(G& graph) noexcept {
    workers.begin(graph);
    std::vector<std::thread> others;
    for (int w = 1; w < W; ++w) others.emplace_back([&, w] { workers.run(graph, w); });
    workers.run(graph, 0);
    for (std::thread& other : others) other.join();
  }
};

template <int W>
std::vector<double> sums_of() {
  auto graph = std::make_unique<WideGraph>();
  Threads<W> threads;
  std::vector<double> sums;
  for (int i = 0; i < 50; ++i) {
    graph->activate(threads);
    sums.push_back(graph->template output<Result>().sum);
  }
  return sums;
}

TEST(Workers, GiveTheSameBytesAsTheSerialExecutor) {
  auto graph = std::make_unique<WideGraph>();
  Serial serial;
  std::vector<double> sums;
  for (int i = 0; i < 50; ++i) {
    graph->activate(serial);
    sums.push_back(graph->output<Result>().sum);
  }
  EXPECT_NE(sums[49], sums[48]);
  EXPECT_EQ(sums_of<1>(), sums);
  EXPECT_EQ(sums_of<2>(), sums);
  EXPECT_EQ(sums_of<3>(), sums);
}

// Thread that ran each node last. Each node has its own entry, so the threads do not race.
struct NodeThreads {
  std::array<std::thread::id, 10>* threads;
  void on_node_begin(int node) noexcept {
    (*threads)[static_cast<std::size_t>(node)] = std::this_thread::get_id();
  }
  void on_node_end(int /*node*/) noexcept {}
};

TEST(Workers, TakeTheCopiesOfTheirNumberAndLeaveTheRestToTheFirst) {
  static_assert(WideGraph::node_count == 10);
  std::array<std::thread::id, 10> threads{};
  auto graph = std::make_unique<WideGraph>();
  YieldingRest rest;
  Workers<2, YieldingRest, NodeThreads> workers(rest, NodeThreads{&threads});
  workers.begin(*graph);
  std::thread other([&] { workers.run(*graph, 1); });
  const std::thread::id second = other.get_id();
  workers.run(*graph, 0);
  other.join();
  const std::thread::id first = std::this_thread::get_id();
  const std::array<std::thread::id, 10> expected = {first, first, second, first, second,
                                                    first, first, second, first, first};
  EXPECT_EQ(threads, expected);  // Make, Spread x5, SumUp x3, Merge
}

// Counts what the waiting workers do.
struct CountingRest : YieldingRest {
  std::atomic<std::uint32_t> spun{0}, slept{0}, reported{0};
  void spin() noexcept { ++spun; }
  [[nodiscard]] bool sleep(std::uint32_t /*seen*/) noexcept {
    ++slept;
    std::this_thread::yield();
    return false;
  }
  void report_progress() noexcept { ++reported; }
};

// Worker 1 starts only after worker 0 has slept k_sleeps_max times.
TEST(Workers, SleepAfterTheirSpinsAndCountOneOverrunAWait) {
  CountingRest rest;
  rest.spins = 3;
  auto graph = std::make_unique<WideGraph>();
  Workers<2, CountingRest> workers(rest);
  workers.begin(*graph);
  std::thread other([&] {
    while (rest.slept.load() < k_sleeps_max) std::this_thread::yield();
    workers.run(*graph, 1);
  });
  workers.run(*graph, 0);
  other.join();
  EXPECT_LE(rest.spun.load(), 9u) << "three waits of three spins";
  EXPECT_EQ(rest.reported.load(), 3u) << "the last to arrive wakes the other";
  EXPECT_GE(workers.overruns(), 1u);
  EXPECT_LE(workers.overruns(), 3u) << "two workers meet three times, and one of them waits";
}

TEST(Workers, NeverWaitAlone) {
  CountingRest rest;
  auto graph = std::make_unique<WideGraph>();
  Workers<1, CountingRest> workers(rest);
  workers.begin(*graph);
  workers.run(*graph, 0);
  EXPECT_EQ(workers.overruns(), 0u);
  EXPECT_EQ(rest.spun.load() + rest.slept.load(), 0u);
}

}  // namespace
}  // namespace glint::test::workers_test
