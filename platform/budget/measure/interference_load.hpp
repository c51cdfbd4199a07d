// Interference workloads that run beside a measured kernel.
//
//   cache       another core writes to a buffer of the size of its caches, at random
//   bandwidth   another core streams through memory
//   other_core  another core computes, without memory accesses
//   interrupts  a thread on the measured core wakes up every 100 us
#pragma once

#include <atomic>
#include <string>
#include <thread>

namespace glint {

inline constexpr int k_measured_core = 0;

class InterferenceLoad {
 public:
  // "none" starts no thread. On a single-core machine, all workloads share the core.
  explicit InterferenceLoad(const std::string& name);
  ~InterferenceLoad();
  InterferenceLoad(const InterferenceLoad&) = delete;
  InterferenceLoad& operator=(const InterferenceLoad&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

void stay_on_core(int core);

}  // namespace glint
