#include "platform/runtime/rt/cycle_clock.hpp"

namespace glint {
namespace {

constexpr Duration k_measured_for = milliseconds(5);

double measure() noexcept {
  const Time begin = monotonic_now();
  const std::uint64_t first = cycle_count();
  Time end = begin;
  while (end - begin < k_measured_for) end = monotonic_now();
  const std::uint64_t cycles = cycle_count() - first;
  return cycles > 0 ? static_cast<double>((end - begin).nanoseconds) / static_cast<double>(cycles)
                    : 1.0;
}

}  // namespace

double ns_per_cycle() noexcept {
  static const double value = measure();
  return value;
}

}  // namespace glint
