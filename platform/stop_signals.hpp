// SIGINT (Ctrl-C) and SIGTERM end a run at once, with its figures and everything written.
#pragma once

#include <atomic>
#include <csignal>

namespace glint {

inline std::atomic<bool> g_stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler stores it");

// Set by either signal from now on.
[[nodiscard]] inline const std::atomic<bool>& stop_on_signals() noexcept {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, [](int) { g_stop_requested = true; });
  }
  return g_stop_requested;
}

}  // namespace glint
