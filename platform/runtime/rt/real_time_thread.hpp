// Threads with core affinity and SCHED_FIFO, as far as the system grants them. Nothing fails: a
// refused right is reported, and the thread runs without it.
#pragma once

#include <functional>
#include <string>
#include <thread>

namespace glint {

struct ThreadSettings {
  std::string name;              // the first 15 characters are visible in system tools
  int core = -1;                 // run on this core only; -1: on any
  int priority = 0;              // SCHED_FIFO, 1 to 99; 0: default scheduling
  bool idle_if_refused = false;  // if SCHED_FIFO is refused: SCHED_IDLE, below all other threads
};

struct ThreadReport {
  std::string name;
  bool pinned = false;     // to the requested core
  bool real_time = false;  // SCHED_FIFO at the requested priority
  std::string refused;     // requested rights that were refused, with the system's reason
};

// Applies the settings to the calling thread.
ThreadReport apply_settings(const ThreadSettings& settings);

// A thread that applies its settings before its body starts. The destructor joins it; the body must
// return by then.
class RealTimeThread {
 public:
  RealTimeThread(const ThreadSettings& settings, std::function<void()> body);
  ~RealTimeThread() { join(); }
  RealTimeThread(const RealTimeThread&) = delete;
  RealTimeThread& operator=(const RealTimeThread&) = delete;

  void join();
  [[nodiscard]] const ThreadReport& report() const noexcept { return report_; }

 private:
  ThreadReport report_;
  std::thread thread_;
};

}  // namespace glint
