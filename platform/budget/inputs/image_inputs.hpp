// Measured kernels that process pixels, with their inputs; image_inputs.cpp has the list.
#pragma once

#include <memory>

#include "platform/budget/inputs/drawn_frame.hpp"

namespace glint {

[[nodiscard]] std::unique_ptr<MeasuredKernel> measured_roi_threshold();
[[nodiscard]] std::unique_ptr<MeasuredKernel> measured_find_blobs();
[[nodiscard]] std::unique_ptr<MeasuredKernel> measured_back_project();

// Threshold in the units of a drawn frame with the limits' bytes per pixel.
[[nodiscard]] constexpr std::uint16_t drawn_threshold(const Limits& limits) {
  return limits.reflectivity_bytes == 1 ? k_drawn_threshold >> 8 : k_drawn_threshold;
}

// A random pattern: initial value and mutations of a bounded search.
[[nodiscard]] RunPattern random_pattern(CounterRandom& random, const Limits& limits);

inline constexpr int k_search_tries = 4;

// Hill climbing: starts from `best`, then tries change(best) k_search_tries times and keeps a
// higher score. score() builds the input and runs the kernel once.
template <class Parameters, class Change, class Score>
[[nodiscard]] Parameters climb(Parameters best, Change change, Score score) {
  std::int64_t most = score(best);
  for (int i = 0; i < k_search_tries; ++i) {
    const Parameters next = change(best);
    const std::int64_t scored = score(next);
    if (scored > most) {
      most = scored;
      best = next;
    }
  }
  return best;
}

}  // namespace glint
