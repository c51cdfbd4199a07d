// A model of two threads that share memory: runs every interleaving of their atomic steps, and
// knows which accesses the memory orders put in sequence.
//
// A state is a plain value with `void step(int thread)` and `bool finished(int thread)`. Each step
// does at most one atomic operation or touches one word of data. Data is guarded by vector clocks
// (Mattern 1989): an access that the orders do not put after the other thread's last one is a race.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <utility>

namespace glint::test {

using Clock = std::array<int, 2>;  // what a thread knows of its own and the other's progress

// The thread that is taking a step, and what both know.
struct Clocks {
  std::array<Clock, 2> of{};
};
inline Clocks* model_clocks = nullptr;
inline int model_thread = 0;

inline Clock joined(const Clock& a, const Clock& b) {
  return {std::max(a[0], b[0]), std::max(a[1], b[1])};
}
inline Clock& model_clock() { return model_clocks->of[static_cast<std::size_t>(model_thread)]; }

// Stands in for std::atomic. With `ordered` false every operation counts as relaxed.
template <bool ordered>
class ModelAtomic {
 public:
  ModelAtomic(std::uint32_t value) : value_(value) {}  // NOLINT: as std::atomic has it
  [[nodiscard]] std::uint32_t load(std::memory_order order) const {
    acquire(order);
    return value_;
  }
  void store(std::uint32_t value, std::memory_order order) {
    value_ = value;
    handed_over_ = Clock{};
    release(order);
  }
  std::uint32_t exchange(std::uint32_t value, std::memory_order order) {
    acquire(order);
    release(order);  // what earlier exchanges released stays released: a release sequence
    return std::exchange(value_, value);
  }

 private:
  void acquire(std::memory_order order) const {
    const bool does = order == std::memory_order_acquire || order == std::memory_order_acq_rel;
    if (ordered && does) model_clock() = joined(model_clock(), handed_over_);
  }
  void release(std::memory_order order) {
    const bool does = order == std::memory_order_release || order == std::memory_order_acq_rel;
    if (ordered && does) handed_over_ = joined(handed_over_, model_clock());
  }
  std::uint32_t value_;
  Clock handed_over_{};
};

// A word of plain data; touching it says whether the access was a race.
struct Word {
  int value = 0;
  Clock last{};

  [[nodiscard]] bool touch() {
    Clock& mine = model_clock();
    const auto self = static_cast<std::size_t>(model_thread);
    const bool in_sequence = last[1 - self] <= mine[1 - self];
    last[self] = ++mine[self];
    return in_sequence;
  }
};

struct Verdict {
  long interleavings = 0;
  long races = 0;
  long faults = 0;  // of the protocol: torn, out of order, stale, lost
};

// Every interleaving from this state on. A state collects its own races and faults.
template <class State>
void explore(const State& state, Verdict& verdict) {
  bool ended = true;
  for (int thread = 0; thread < 2; ++thread) {
    if (state.finished(thread)) continue;
    ended = false;
    State next = state;
    model_thread = thread;
    model_clocks = &next.clocks;
    next.step(thread);
    explore(next, verdict);
  }
  if (!ended) return;
  ++verdict.interleavings;
  verdict.races += state.races;
  verdict.faults += state.faults;
}

}  // namespace glint::test
