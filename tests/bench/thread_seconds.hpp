// What the calling thread has computed so far: a race's clock, which other processes do not move.
#pragma once

#include <ctime>

namespace glint::bench {

inline double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace glint::bench
