#include "handover.hpp"

#include <atomic>
#include <vector>

#include "platform/runtime/rt/cycle_clock.hpp"
#include "platform/runtime/rt/real_time_thread.hpp"
#include "platform/tools/report/statistics.hpp"

namespace glint::bench {
namespace {

constexpr int k_trips = 20'000;

struct alignas(64) Ball {
  std::atomic<int> trip{0};
};

}  // namespace

std::int64_t measured_core_delay_ns(int from, int to) {
  apply_settings({"there", from, 0});
  Ball there, back;
  std::vector<double> ns;
  RealTimeThread other({"back", to, 0}, [&] {
    for (int trip = 1; trip <= k_trips; ++trip) {
      while (there.trip.load(std::memory_order_acquire) != trip) {
      }
      back.trip.store(trip, std::memory_order_release);
    }
  });
  for (int trip = 1; trip <= k_trips; ++trip) {
    const std::uint64_t begin = cycle_count();
    there.trip.store(trip, std::memory_order_release);
    while (back.trip.load(std::memory_order_acquire) != trip) {
    }
    ns.push_back(static_cast<double>(cycle_count() - begin) * ns_per_cycle());
  }
  return static_cast<std::int64_t>(percentile(ns, 0.5) / 2);
}

}  // namespace glint::bench
