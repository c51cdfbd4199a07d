// Model checker for the triple buffer: every interleaving of writer and reader on its own code.
#include <gtest/gtest.h>

#include "graph/latest.hpp"
#include "model.hpp"

namespace glint::test::latest_model_test {
namespace {

// A slot of two words: a torn read gives two different values.
struct Slot {
  Word first, second;
};

template <class Index, int publishes, int samples>
struct Model {
  Index index;
  std::array<Slot, 3> slots{};
  Clocks clocks;
  int published = 0, writer_at = 0;
  int sampled = 0, reader_at = 0;
  int newest = 0;  // published when the sample took effect
  int read_first = 0, last_seen = 0;
  int races = 0, faults = 0;

  [[nodiscard]] bool finished(int thread) const {
    return thread == 0 ? published == publishes : sampled == samples;
  }
  void step(int thread) { thread == 0 ? write() : read(); }

  void write() {
    Slot& slot = slots[static_cast<std::size_t>(index.writer_slot())];
    if (writer_at < 2) {
      Word& word = writer_at == 0 ? slot.first : slot.second;
      races += word.touch() ? 0 : 1;
      word.value = published + 1;
      ++writer_at;
    } else {
      index.publish();
      ++published;
      writer_at = 0;
    }
  }

  void read() {
    if (reader_at == 0) {
      reader_at = index.fresh() ? 1 : 2;
      newest = published;
    } else if (reader_at == 1) {
      index.take();
      newest = published;
      reader_at = 2;
    } else {
      Slot& slot = slots[static_cast<std::size_t>(index.reader_slot())];
      Word& word = reader_at == 2 ? slot.first : slot.second;
      races += word.touch() ? 0 : 1;
      if (reader_at == 2) {
        read_first = word.value;
        reader_at = 3;
        return;
      }
      const bool torn = word.value != read_first;
      const bool backwards = word.value < last_seen;
      const bool stale = word.value != newest;
      faults += torn || backwards || stale ? 1 : 0;
      last_seen = word.value;
      ++sampled;
      reader_at = 0;
    }
    faults += index.writer_slot() == index.reader_slot() ? 1 : 0;
  }
};

template <class Index, int publishes, int samples>
Verdict verdict_of() {
  Verdict verdict;
  explore(Model<Index, publishes, samples>{}, verdict);
  return verdict;
}

using Ordered = graph::TripleIndex<ModelAtomic<true>>;

TEST(LatestModel, NeverSharesASlotGoesBackOrMissesTheNewest) {
  const Verdict few_samples = verdict_of<Ordered, 5, 2>();
  const Verdict many_samples = verdict_of<Ordered, 2, 4>();
  const Verdict even = verdict_of<Ordered, 3, 3>();
  EXPECT_GT(even.interleavings, 50'000);
  for (const Verdict& verdict : {few_samples, many_samples, even}) {
    EXPECT_GT(verdict.interleavings, 1);
    EXPECT_EQ(verdict.races, 0);
    EXPECT_EQ(verdict.faults, 0);
  }
}

TEST(LatestModel, WouldFindAMissingMemoryOrder) {
  EXPECT_GT((verdict_of<graph::TripleIndex<ModelAtomic<false>>, 2, 2>().races), 0);
}

// Faulty reader: takes a slot without checking for a newer one.
struct UncheckedReader : Ordered {
  [[nodiscard]] bool fresh() const { return true; }
};

TEST(LatestModel, WouldFindAReaderThatGoesBackwards) {
  EXPECT_GT((verdict_of<UncheckedReader, 2, 2>().faults), 0);
}

// Faulty double buffer: the writer may fill the slot that the reader is reading.
class Double {
 public:
  [[nodiscard]] int writer_slot() const { return writer_; }
  [[nodiscard]] int reader_slot() const { return reader_; }
  void publish() {
    newest_.exchange(static_cast<std::uint32_t>(writer_), std::memory_order_acq_rel);
    writer_ = 1 - writer_;
  }
  [[nodiscard]] bool fresh() const { return true; }
  void take() { reader_ = static_cast<int>(newest_.load(std::memory_order_acquire)); }

 private:
  ModelAtomic<true> newest_{1};
  int writer_ = 0, reader_ = 1;
};

TEST(LatestModel, WouldFindATornReadInADoubleBuffer) {
  const Verdict verdict = verdict_of<Double, 3, 2>();
  EXPECT_GT(verdict.races, 0);
  EXPECT_GT(verdict.faults, 0);
}

}  // namespace
}  // namespace glint::test::latest_model_test
