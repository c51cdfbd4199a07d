// Named disturbances that a kernel is measured beside.
//
//   cache       another core writes all over a buffer of the size of its caches
//   bandwidth   another core streams through memory
//   other_core  another core computes, without memory
//   interrupts  a thread on the measured core wakes up every 100 us
#pragma once

#include <atomic>
#include <string>
#include <thread>

namespace glint {

inline constexpr int k_measured_core = 0;

class Enemy {
 public:
  // "none" is nobody. With one core only, all of them share it.
  explicit Enemy(const std::string& name);
  ~Enemy();
  Enemy(const Enemy&) = delete;
  Enemy& operator=(const Enemy&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

void stay_on_core(int core);

}  // namespace glint
