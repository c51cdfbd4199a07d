// Exposure and arrival times of the frames of the experiment `rates`, with injected faults.
#pragma once

#include <cstdint>
#include <vector>

#include "platform/sim/timing.hpp"

namespace glint {

// Camera rate: 45 Hz, then 5 Hz between these times, then 45 Hz again.
inline constexpr Time k_slow_from{5'000'000'000}, k_slow_until{10'000'000'000};
inline constexpr Duration k_rates_length = milliseconds(15'000);

// Fractions of the frames; a frame has at most one fault.
struct FrameFaults {
  double dropped = 0;
  double duplicated = 0;     // delivered again 5 ms later
  double backward = 0;       // stamped a second before its exposure, older than any kept frame
  double late = 0;           // 60 ms later; at 45 Hz after its successors
  Duration exposure_jitter;  // largest offset of an exposure and its stamp
  Duration transport_jitter = microseconds(400);
};

// Returns the frames in order of arrival. The first frame has no fault.
[[nodiscard]] std::vector<sim::FrameTiming> rates_schedule(const Camera& camera,
                                                           const FrameFaults& faults,
                                                           std::uint64_t seed);

}  // namespace glint
