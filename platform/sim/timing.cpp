#include "platform/sim/timing.hpp"

#include <algorithm>
#include <cstddef>

#include "platform/sim/random.hpp"

namespace glint::sim {
namespace {

bool is_slow(const TimingSettings& settings, Time t) {
  return std::any_of(settings.slow.begin(), settings.slow.end(),
                     [t](const Interval& interval) { return interval.contains(t); });
}

}  // namespace

std::vector<FrameTiming> frame_timings(const Camera& camera, const TimingSettings& settings,
                                       Duration duration, std::uint64_t seed) {
  const RandomKey key{seed, Stream::transport};
  const Duration half_exposure{camera.exposure.nanoseconds / 2};
  std::vector<FrameTiming> deliveries;
  std::vector<bool> happened(settings.faults.size(), false);
  Time exposed;
  for (std::uint64_t sequence = 0; exposed < Time{duration.nanoseconds}; ++sequence) {
    FrameTiming timing;
    timing.exposed = exposed;
    timing.mid_exposure = exposed + settings.stamp_offset;
    const double share = uniform(key, sequence);
    const Duration jitter{static_cast<std::int64_t>(
        share * static_cast<double>(settings.transport_jitter.nanoseconds))};
    timing.arrival = exposed + half_exposure + camera.transport + jitter;
    timing.sequence = sequence;
    bool arrives = true;
    std::vector<FrameTiming> copies;
    for (std::size_t i = 0; i < settings.faults.size(); ++i) {
      const FaultEvent& fault = settings.faults[i];
      if (happened[i] || exposed < fault.at) continue;
      happened[i] = true;
      if (fault.kind == Fault::late) timing.arrival = timing.arrival + fault.amount;
      if (fault.kind == Fault::backward_stamp)
        timing.mid_exposure = timing.mid_exposure - fault.amount;
      if (fault.kind == Fault::dropped) arrives = false;
      if (fault.kind == Fault::doubled) {
        copies.push_back(timing);
        copies.back().arrival = timing.arrival + fault.amount;
      }
    }
    if (arrives) {
      deliveries.push_back(timing);
      deliveries.insert(deliveries.end(), copies.begin(), copies.end());
    }
    exposed = exposed + (is_slow(settings, exposed) ? settings.slow_period : camera.period);
  }
  std::stable_sort(
      deliveries.begin(), deliveries.end(),
      [](const FrameTiming& a, const FrameTiming& b) { return a.arrival < b.arrival; });
  return deliveries;
}

}  // namespace glint::sim
