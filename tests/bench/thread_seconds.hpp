// CPU time of the calling thread: the clock of the benchmarks, independent of other processes.
#pragma once

#include <ctime>

namespace glint::bench {

inline double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace glint::bench
