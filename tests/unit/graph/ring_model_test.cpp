// Model checker for the ring: every interleaving of producer and consumer on its own code.
#include <gtest/gtest.h>

#include "graph/ring.hpp"
#include "model.hpp"

namespace glint::test::ring_model_test {
namespace {

struct Slot {
  Word first, second;
};

template <class Index, int N, int pushes, int pops>
struct Model {
  Index index{0xFFFF'FFFFu};  // the counters wrap after the first item
  std::array<Slot, static_cast<std::size_t>(N)> slots{};
  Clocks clocks;
  int offered = 0, pushed = 0, dropped = 0, producer_at = 0;
  int tried = 0, popped = 0, consumer_at = 0;
  int read_first = 0;
  int races = 0, faults = 0;

  [[nodiscard]] bool finished(int thread) const {
    return thread == 0 ? offered == pushes : tried == pops;
  }
  void step(int thread) {
    thread == 0 ? produce() : consume();
    faults += pushed - popped < 0 || pushed - popped > N ? 1 : 0;
  }

  void produce() {
    if (producer_at == 0) {
      if (index.has_room()) {
        producer_at = 1;
      } else {
        faults += pushed - popped == N ? 0 : 1;  // dropped although a slot was free
        ++dropped;
        ++offered;
      }
    } else if (producer_at < 3) {
      Slot& slot = slots[static_cast<std::size_t>(index.push_slot())];
      Word& word = producer_at == 1 ? slot.first : slot.second;
      races += word.touch() ? 0 : 1;
      word.value = pushed + 1;
      ++producer_at;
    } else {
      index.push();
      ++pushed;
      ++offered;
      producer_at = 0;
    }
  }

  void consume() {
    if (consumer_at == 0) {
      if (index.has_item()) {
        consumer_at = 1;
      } else {
        faults += pushed == popped ? 0 : 1;  // found empty although an item was there
        ++tried;
      }
    } else if (consumer_at < 3) {
      Slot& slot = slots[static_cast<std::size_t>(index.pop_slot())];
      Word& word = consumer_at == 1 ? slot.first : slot.second;
      races += word.touch() ? 0 : 1;
      if (consumer_at == 1) {
        read_first = word.value;
      } else {
        const bool next_in_order = word.value == popped + 1 && read_first == popped + 1;
        faults += next_in_order ? 0 : 1;
      }
      ++consumer_at;
    } else {
      index.pop();
      ++popped;
      ++tried;
      consumer_at = 0;
    }
  }
};

template <int N, int pushes, int pops, class Atomic = ModelAtomic<true>>
Verdict verdict_of() {
  Verdict verdict;
  explore(Model<graph::RingIndex<N, Atomic>, N, pushes, pops>{}, verdict);
  return verdict;
}

TEST(RingModel, NeverSharesASlotLosesOrReordersAnItem) {
  const Verdict smallest = verdict_of<1, 4, 4>();
  const Verdict fills_up = verdict_of<2, 4, 2>();
  const Verdict runs_empty = verdict_of<2, 2, 4>();
  EXPECT_GT(fills_up.interleavings, 10'000);
  for (const Verdict& verdict : {smallest, fills_up, runs_empty}) {
    EXPECT_GT(verdict.interleavings, 1);
    EXPECT_EQ(verdict.races, 0);
    EXPECT_EQ(verdict.faults, 0);
  }
}

TEST(RingModel, WouldFindAMissingMemoryOrder) {
  EXPECT_GT((verdict_of<1, 2, 2, ModelAtomic<false>>().races), 0);
}

// Faulty ring: one slot fewer than the counters admit.
struct UndersizedRing : graph::RingIndex<2, ModelAtomic<true>> {
  using RingIndex::RingIndex;
  [[nodiscard]] int push_slot() const { return 0; }
  [[nodiscard]] int pop_slot() const { return 0; }
};

TEST(RingModel, WouldFindAnOverwrittenItem) {
  Verdict verdict;
  explore(Model<UndersizedRing, 2, 3, 2>{}, verdict);
  EXPECT_GT(verdict.races, 0);
  EXPECT_GT(verdict.faults, 0);
}

}  // namespace
}  // namespace glint::test::ring_model_test
