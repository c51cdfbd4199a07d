#include "platform/lab/experiments/rates_schedule.hpp"

#include <algorithm>
#include <optional>

#include "platform/sim/random.hpp"

namespace glint {
namespace {

constexpr Duration k_doubled_after = milliseconds(5), k_late_by = milliseconds(60);
// Longer than any gap between kept frames: at 5 Hz, four frames in a row would have to be lost.
constexpr Duration k_backward_by = milliseconds(1000);

std::optional<sim::FaultEvent> fault_at(const FrameFaults& faults, double share, Time at) {
  if ((share -= faults.dropped) < 0) return {{sim::Fault::dropped, at, {}}};
  if ((share -= faults.duplicated) < 0) return {{sim::Fault::doubled, at, k_doubled_after}};
  if ((share -= faults.backward) < 0) return {{sim::Fault::backward_stamp, at, k_backward_by}};
  if ((share -= faults.late) < 0) return {{sim::Fault::late, at, k_late_by}};
  return {};
}

}  // namespace

std::vector<sim::FrameTiming> rates_schedule(const Camera& camera, const FrameFaults& faults,
                                             std::uint64_t seed) {
  sim::TimingSettings settings;
  settings.slow.push_back({k_slow_from, k_slow_until});
  settings.transport_jitter = faults.transport_jitter;
  const sim::RandomKey chance{seed, sim::Stream::transport, 1};
  const sim::RandomKey place{seed, sim::Stream::transport, 2};
  for (const sim::FrameTiming& frame : sim::frame_timings(camera, settings, k_rates_length, seed)) {
    if (frame.sequence == 0) continue;  // a wrong first time stamp is not detectable
    const double share = sim::uniform(chance, frame.sequence);
    if (const auto fault = fault_at(faults, share, frame.exposed))
      settings.faults.push_back(*fault);
  }
  std::vector<sim::FrameTiming> frames = sim::frame_timings(camera, settings, k_rates_length, seed);
  for (sim::FrameTiming& frame : frames) {
    const double share = 2 * sim::uniform(place, frame.sequence) - 1;
    const Duration off{
        static_cast<std::int64_t>(share * static_cast<double>(faults.exposure_jitter.nanoseconds))};
    frame.exposed = frame.exposed + off;
    frame.mid_exposure = frame.mid_exposure + off;
    frame.arrival = frame.arrival + off;
  }
  std::stable_sort(
      frames.begin(), frames.end(),
      [](const sim::FrameTiming& a, const sim::FrameTiming& b) { return a.arrival < b.arrival; });
  return frames;
}

}  // namespace glint
