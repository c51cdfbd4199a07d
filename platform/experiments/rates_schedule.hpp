// When the frames of the experiment `rates` are exposed and arrive, and what befalls them.
#pragma once

#include <cstdint>
#include <vector>

#include "platform/sim/timing.hpp"

namespace glint {

// The camera gives 45 Hz, from here 5 Hz, and from there 45 Hz again.
inline constexpr Time k_slow_from{5'000'000'000}, k_slow_until{10'000'000'000};
inline constexpr Duration k_rates_length = milliseconds(15'000);

// Parts of the frames; a frame has one mishap at most.
struct Mishaps {
  double dropped = 0;
  double doubled = 0;        // delivered again 5 ms later
  double backward = 0;       // stamped a second before its exposure, older than any frame kept
  double late = 0;           // 60 ms later, at 45 Hz behind its successors
  Duration exposure_jitter;  // each exposure off its place by up to this, its stamp with it
  Duration transport_jitter = microseconds(400);
};

// In the order of arrival. The first frame has no mishap.
[[nodiscard]] std::vector<sim::FrameTiming> rates_schedule(const Camera& camera,
                                                           const Mishaps& mishaps,
                                                           std::uint64_t seed);

}  // namespace glint
