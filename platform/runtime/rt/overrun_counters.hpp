// Counters of overruns, published to reporting threads.
#pragma once

#include <atomic>
#include <cstdint>

namespace glint {

struct OverrunCounters {
  std::atomic<std::uint64_t> frame{0}, tick{0};
  std::atomic<std::uint64_t> source{0};  // ticks without a measurement: the source was late
};

}  // namespace glint
