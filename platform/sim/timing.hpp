// Exposure and arrival times of frames, with jitter and faults.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/units.hpp"
#include "platform/formats/camera.hpp"

namespace glint::sim {

// Half open: begin <= t < end.
struct Interval {
  Time begin, end;
  [[nodiscard]] bool contains(Time t) const { return t >= begin && t < end; }
};

enum class Fault : std::uint8_t {
  doubled,         // delivered twice, `amount` apart
  late,            // arrives `amount` later, possibly after its successors
  backward_stamp,  // stamp is `amount` before the true mid-exposure
  dropped,         // never arrives
};

// Affects the first frame exposed at `at` or later.
struct FaultEvent {
  Fault kind = Fault::doubled;
  Time at;
  Duration amount;
};

struct TimingSettings {
  std::vector<Interval> slow;  // the camera has slow_period here
  Duration slow_period = milliseconds(200);
  Duration transport_jitter = microseconds(400);  // added to Camera::transport, uniform
  Duration stamp_offset;                          // of every stamp
  std::vector<FaultEvent> faults;
};

// One delivery; deliveries are numbered in order of arrival.
struct FrameTiming {
  Time exposed;                // true mid-exposure
  Time mid_exposure;           // as stamped: differs by stamp_offset and Fault::backward_stamp
  Time arrival;                // last byte in memory
  std::uint64_t sequence = 0;  // counts exposures; the same for a doubled frame
};

// The camera's clock starts at 0 at its first mid-exposure; the last one is before `duration`.
[[nodiscard]] std::vector<FrameTiming> frame_timings(const Camera& camera,
                                                     const TimingSettings& settings,
                                                     Duration duration, std::uint64_t seed);

}  // namespace glint::sim
