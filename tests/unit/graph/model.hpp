// Model checker for two threads with shared memory: explores every interleaving of their atomic
// steps and detects data races by vector clocks (Mattern 1989).
//
// A state is a plain value with `void step(int thread)` and `bool finished(int thread)`. Each step
// does at most one atomic operation or one access to a word of data. An access is a race if the
// memory orders do not put it after the other thread's last access.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <utility>

namespace glint::test {

using Clock = std::array<int, 2>;  // progress of each thread, as one thread has observed it

// The thread that takes the current step, and the vector clocks of both.
struct Clocks {
  std::array<Clock, 2> of{};
};
inline Clocks* model_clocks = nullptr;
inline int model_thread = 0;

inline Clock joined(const Clock& a, const Clock& b) {
  return {std::max(a[0], b[0]), std::max(a[1], b[1])};
}
inline Clock& model_clock() { return model_clocks->of[static_cast<std::size_t>(model_thread)]; }

// Replaces std::atomic. If `ordered` is false, every operation is relaxed.
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
    release(order);  // earlier exchanges stay released: a release sequence
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

// A word of plain data. Each access returns whether it was a race.
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

// Explores every interleaving from `state`. The state counts its own races and faults.
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
