// Stop by signal: SIGINT (Ctrl-C), SIGTERM and SIGHUP (terminal closed) end a run at once. Its
// figures and all output are still written.
#pragma once

#include <atomic>
#include <csignal>

namespace glint {

inline std::atomic<bool> g_stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler stores it");

// Installs the signal handlers and returns the flag that they set. A SIGHUP that is ignored (nohup)
// stays ignored.
[[nodiscard]] inline const std::atomic<bool>& stop_on_signals() noexcept {
  const auto stop = [](int) { g_stop_requested = true; };
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, stop);
  if (std::signal(SIGHUP, stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  return g_stop_requested;
}

}  // namespace glint
