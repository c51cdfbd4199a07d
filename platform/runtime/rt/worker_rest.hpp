// Wait policy of a graph's workers (graph/rest.hpp): bounded spin, then sleep. If each worker has
// its own core and SCHED_FIFO, the spin lasts some milliseconds. Otherwise another thread may need
// the core, and a worker sleeps soon.
#pragma once

#include <algorithm>
#include <atomic>
#include <climits>
#include <cstdint>
#include <vector>

#include "platform/runtime/rt/clock.hpp"
#include "platform/runtime/rt/futex.hpp"
#include "platform/runtime/rt/real_time_thread.hpp"

namespace glint {

class WorkerWaitPolicy {
 public:
  // 20 to 40 us: the cost of a sleep and its wake-up.
  static constexpr std::uint32_t k_shared_core_spins_max = 1000;
  static constexpr Duration k_sleep_max = microseconds(200);

  // `reports` of the workers' threads: the rights granted by the system.
  WorkerWaitPolicy(const std::vector<ThreadReport>& reports, std::uint32_t spins_max) noexcept
      : spins_max_(spins_max) {
    for (const ThreadReport& report : reports) {
      if (report.pinned && report.real_time) continue;
      spins_max_ = std::min(spins_max_, k_shared_core_spins_max);
    }
  }

  void spin() const noexcept {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ __volatile__("yield");
#endif
  }
  [[nodiscard]] std::uint32_t spins_max() const noexcept { return spins_max_; }

  [[nodiscard]] std::uint32_t progress() const noexcept { return progress_.load(); }
  [[nodiscard]] bool sleep(std::uint32_t seen) noexcept {
    const Time deadline = monotonic_now() + k_sleep_max;
    sleepers_.fetch_add(1);
    const bool in_time = futex_sleep(progress_, seen, &deadline);
    sleepers_.fetch_sub(1);
    return in_time;
  }
  // Makes a system call only if a worker sleeps. Both counters are sequentially consistent: either
  // this call reads the sleeper, or the sleeper reads the new count and does not sleep.
  void report_progress() noexcept {
    progress_.fetch_add(1);
    if (sleepers_.load() != 0) futex_wake(progress_, INT_MAX);
  }

 private:
  std::uint32_t spins_max_;
  alignas(64) std::atomic<std::uint32_t> progress_{0};
  alignas(64) std::atomic<std::uint32_t> sleepers_{0};
};

}  // namespace glint
