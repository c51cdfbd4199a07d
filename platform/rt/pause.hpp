// How a spin rests: with real-time rights the other worker has a core of its own, and the CPU's
// pause instruction is enough; without them the spin yields, so that the other gets to run at all.
#pragma once

#include <sched.h>

#include <vector>

#include "platform/rt/real_time_thread.hpp"

namespace glint {

class Pause {
 public:
  Pause() = default;
  explicit Pause(bool yields) noexcept : yields_(yields) {}

  // Yields unless every thread was given both a core and real-time scheduling.
  [[nodiscard]] static Pause granted(const std::vector<ThreadReport>& reports) noexcept {
    bool all = true;
    for (const ThreadReport& report : reports) all = all && report.pinned && report.real_time;
    return Pause(!all);
  }

  void operator()() const noexcept {
    if (yields_) {
      sched_yield();
      return;
    }
#if defined(__x86_64__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ __volatile__("yield");
#endif
  }
  [[nodiscard]] bool yields() const noexcept { return yields_; }

 private:
  bool yields_ = true;
};

}  // namespace glint
