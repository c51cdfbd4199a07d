#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

#include "wide_graph.hpp"

namespace glint::test {
namespace {

struct Yield {
  void operator()() const noexcept { std::this_thread::yield(); }
};

// Hosts the workers in threads that live for one activation: slow, but nothing to go wrong.
template <int W>
struct Threads {
  Workers<W, Yield> workers{1'000'000};
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

// Which thread ran each node last; every node has an entry of its own, so threads do not collide.
struct Whereabouts {
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
  Workers<2, Yield, Whereabouts> workers(1'000'000, {}, Whereabouts{&threads});
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

TEST(Workers, CountOneOverrunForAWaitBeyondItsSpins) {
  struct Pause {
    std::atomic<bool>* late;
    void operator()() const noexcept {
      late->store(true);
      std::this_thread::yield();
    }
  };
  std::atomic<bool> late{false};
  auto graph = std::make_unique<WideGraph>();
  Workers<2, Pause> workers(1, Pause{&late});
  workers.begin(*graph);
  // Worker 1 sets out only when worker 0 has already spun once.
  std::thread other([&] {
    while (!late.load()) std::this_thread::yield();
    workers.run(*graph, 1);
  });
  workers.run(*graph, 0);
  other.join();
  EXPECT_GE(workers.overruns(), 1u);
  EXPECT_LE(workers.overruns(), 6u) << "two workers meet three times: at most one each";
}

TEST(Workers, NeverWaitAlone) {
  struct Fail {
    void operator()() const noexcept { ADD_FAILURE() << "a single worker has nobody to wait for"; }
  };
  auto graph = std::make_unique<WideGraph>();
  Workers<1, Fail> workers(1);
  workers.begin(*graph);
  workers.run(*graph, 0);
  EXPECT_EQ(workers.overruns(), 0u);
}

}  // namespace
}  // namespace glint::test
