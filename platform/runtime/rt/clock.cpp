#include "platform/runtime/rt/clock.hpp"

#include <cerrno>
#include <ctime>
#include <limits>

namespace glint {
namespace {

constexpr std::int64_t k_second = 1'000'000'000;
constexpr int k_clock_pairs = 8;  // one of them without preemption is enough

std::int64_t read(clockid_t clock) noexcept {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<std::int64_t>(now.tv_sec) * k_second + now.tv_nsec;
}

}  // namespace

Time monotonic_now() noexcept { return {read(CLOCK_MONOTONIC)}; }

Duration unix_offset() noexcept {
  std::int64_t tightest = std::numeric_limits<std::int64_t>::max();
  std::int64_t offset = 0;
  for (int pair = 0; pair < k_clock_pairs; ++pair) {
    const std::int64_t before = read(CLOCK_MONOTONIC);
    const std::int64_t unix_time = read(CLOCK_REALTIME);
    const std::int64_t after = read(CLOCK_MONOTONIC);
    if (after - before < tightest) {
      tightest = after - before;
      offset = unix_time - before - tightest / 2;
    }
  }
  return {offset};
}

bool sleep_until(Time wake) noexcept {
  if (wake <= monotonic_now()) return true;
  const timespec until{static_cast<time_t>(wake.nanoseconds / k_second),
                       static_cast<long>(wake.nanoseconds % k_second)};
  int error = EINTR;
  while (error == EINTR) {
    error = clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
  }
  return error == 0;
}

}  // namespace glint
