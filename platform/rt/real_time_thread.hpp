// Real-time rights as far as the system grants them. Nothing here fails: what was refused is
// reported, and the work goes on without it.
#pragma once

#include <functional>
#include <string>
#include <thread>

namespace glint {

struct ThreadSettings {
  std::string name;             // the first 15 characters show in the system's tools
  int core = -1;                // to run on this core alone; -1: on any
  int priority = 0;             // SCHED_FIFO, 1 to 99; 0: the usual scheduling
  bool idle_otherwise = false;  // where SCHED_FIFO is refused: SCHED_IDLE, beneath all others
};

struct ThreadReport {
  std::string name;
  bool pinned = false;     // on the core asked for
  bool real_time = false;  // SCHED_FIFO at the priority asked for
  std::string refused;     // what was asked for and not granted, with the system's reason
};

// Gives the calling thread what the settings ask for.
ThreadReport become(const ThreadSettings& settings);

// A thread that has become what its settings ask for before its body begins. Joined at the end of
// its life; the body has to return by then.
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
