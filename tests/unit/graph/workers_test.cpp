#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

#include "small_graph.hpp"

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

struct Wide {
  std::array<double, 64> values{};
};
struct Narrow {
  std::array<double, 64> values{};
};
struct Partial {
  double sum = 0;
};
struct Result {
  double sum = 0.1;
  std::array<double, 64> values{};
};
struct Spread {
  void operator()(const Narrow& in, const Previous<Result>& last, Slice s, Wide& out) noexcept {
    for (std::size_t i = static_cast<std::size_t>(s.index); i < 64; i += 5) {
      out.values[i] = in.values[i] * (1.0 + last.value().sum) / (3.0 + s.index);
    }
  }
};
struct SumUp {
  void operator()(const Parts<Wide, 5>& in, Slice s, Partial& out) noexcept {
    out.sum = 0;
    for (int part = 0; part < 5; ++part) {
      for (std::size_t i = static_cast<std::size_t>(s.index); i < 64; i += 3) {
        out.sum += in[part].values[i];
      }
    }
  }
};
struct Make {
  int n = 0;
  void operator()(Narrow& out) noexcept {
    ++n;
    for (std::size_t i = 0; i < 64; ++i) {
      out.values[i] = 1.0 / (1.0 + static_cast<double>(i) * n);
    }
  }
};
struct Merge {
  void operator()(const Parts<Partial, 3>& sums, const Narrow& in, Result& out) noexcept {
    out.values = in.values;
    out.sum = 0;
    for (int i = 0; i < 3; ++i) out.sum += sums[i].sum;
  }
};
using WideGraph = Graph<Inputs<>, Outputs<Result>, Merge, Split<SumUp, 3>, Split<Spread, 5>, Make>;
static_assert(valid<WideGraph>);

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
