// Inter-thread communication of real threads, for ThreadSanitizer. All counts are bounded, and the
// results do not depend on timing.
#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "small_graph.hpp"
#include "yielding_rest.hpp"

namespace glint::test::threads_test {
namespace {

struct Message {
  std::array<std::uint64_t, 16> words{};
};

bool all_equal(const Message& message, std::uint64_t value) {
  for (const std::uint64_t word : message.words) {
    if (word != value) return false;
  }
  return true;
}

TEST(Threads, SampleWholeVersionsThatOnlyRise) {
  constexpr std::uint64_t k_versions = 20'000;
  auto buffer = std::make_unique<TripleBuffer<Message>>();
  std::jthread writer([&] {
    for (std::uint64_t version = 1; version <= k_versions; ++version) {
      buffer->write_slot().words.fill(version);
      buffer->publish(version, static_cast<std::int64_t>(2 * version));
    }
  });
  std::uint64_t last = 0;
  while (last < k_versions) {  // ends: the writer publishes all versions, and the last one stays
    if (!buffer->sample()) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_GT(buffer->version(), last);
    last = buffer->version();
    ASSERT_TRUE(all_equal(buffer->value(), last));
    ASSERT_EQ(buffer->time_ns(), static_cast<std::int64_t>(2 * last));
  }
  writer.join();
}

TEST(Threads, PassEveryItemThroughTheRingOrCountIt) {
  constexpr std::uint64_t k_items = 20'000;
  auto ring = std::make_unique<Ring<Message, 8>>();
  std::atomic<bool> ended{false};
  std::jthread producer([&] {
    Message message;
    for (std::uint64_t i = 1; i <= k_items; ++i) {
      message.words.fill(i);
      if (!ring->push(message)) std::this_thread::yield();
    }
    ended.store(true);
  });
  std::uint64_t received = 0;
  std::uint64_t last = 0;
  Message message;
  for (bool more = true; more;) {
    more = !ended.load();  // read before the ring is emptied, so that no item stays behind
    while (ring->pop(message)) {
      ASSERT_GT(message.words[0], last);
      last = message.words[0];
      ASSERT_TRUE(all_equal(message, last));
      ++received;
    }
    std::this_thread::yield();
  }
  producer.join();
  EXPECT_EQ(received + ring->dropped(), k_items);
}

// Two workers over many activations. A counter releases them, as a worker pool does.
TEST(Threads, ShareAGraphActivationAfterActivation) {
  constexpr int k_activations = 500;
  static SmallGraph graph;
  graph.latest<Scale>().set({1}, 1, 0);
  graph.input<Row>().numbers = {1, 2, 3, 4, 5, 6, 7, 8};
  YieldingRest rest;
  Workers<2, YieldingRest> workers(rest);
  std::atomic<int> released{0};
  std::jthread other([&] {
    for (int activation = 1; activation <= k_activations; ++activation) {
      while (released.load(std::memory_order_acquire) < activation) std::this_thread::yield();
      workers.run(graph, 1);
    }
  });
  for (int activation = 1; activation <= k_activations; ++activation) {
    graph.input<Row>().numbers[0] = activation;
    workers.begin(graph);
    released.store(activation, std::memory_order_release);
    workers.run(graph, 0);
  }
  other.join();
  EXPECT_EQ(graph.output<Total>().activations, k_activations);
  EXPECT_EQ(graph.output<Total>().value,
            35 * k_activations + k_activations * (k_activations + 1) / 2);
}

}  // namespace
}  // namespace glint::test::threads_test
