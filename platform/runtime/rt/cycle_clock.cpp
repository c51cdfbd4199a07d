#include "platform/runtime/rt/cycle_clock.hpp"

#include <limits>

namespace glint {
namespace {

constexpr Duration k_measured_for = milliseconds(5);

// Both clocks at one instant. A thread may be preempted between the two reads: the pair with the
// fewest cycles around it counts.
struct Reading {
  Time time;
  std::uint64_t cycles = 0;
};
constexpr int k_pairs = 16;

Reading read_both() noexcept {
  Reading best;
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  for (int i = 0; i < k_pairs; ++i) {
    const std::uint64_t before = cycle_count();
    const Time time = monotonic_now();
    const std::uint64_t between = cycle_count() - before;
    if (between >= least) continue;
    least = between;
    best = {time, before + between / 2};
  }
  return best;
}

double measure() noexcept {
  const Reading begin = read_both();
  while (monotonic_now() - begin.time < k_measured_for) {
  }
  const Reading end = read_both();
  const std::uint64_t cycles = end.cycles - begin.cycles;
  return cycles > 0 ? static_cast<double>((end.time - begin.time).nanoseconds) /
                          static_cast<double>(cycles)
                    : 1.0;
}

}  // namespace

double ns_per_cycle() noexcept {
  static const double value = measure();
  return value;
}

}  // namespace glint
