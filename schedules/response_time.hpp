// Worst-case response time under preemptive fixed-priority scheduling (response-time analysis).
//
// What:     any phasing, release jitter, blocking, and deadlines that may exceed the gap between
//           releases. The q-th activation of a busy period ends at
//             w_q = B + (q + 1) C + sum over higher-priority j of ceil((w_q + J_j) / T_j) C_j
//           after the start of the busy period, and R = max over q of J + w_q - q T.
// Cost:     every step of the fixed point raises w by at least one higher-priority activation; at
//           most k_response_steps_max steps in all, then the result is "unbounded". constexpr.
// Worst:    a load close to one.
// Accuracy: exact for independent sporadic work on one core with simultaneous releases.
// Source:   Joseph and Pandya 1986 and Audsley, Burns, Richardson, Tindell, Wellings 1993, eq. (1)
//           (the recurrence); Tindell, Burns, Wellings 1994, eqs. (2) and (3) (busy period,
//           jitter).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace glint {

// Preempting work: `cost_ns` per release, releases at least `gap_ns` apart, plus or minus
// `jitter_ns`.
struct Interference {
  std::int64_t cost_ns = 0;
  std::int64_t gap_ns = 0;
  std::int64_t jitter_ns = 0;
};

// Maximum steps of all fixed points of one analysis, and the longest busy period analysed.
inline constexpr int k_response_steps_max = 100'000;
inline constexpr std::int64_t k_busy_period_max_ns = 100'000'000'000;  // 100 s

struct WorkUnderAnalysis {
  std::int64_t cost_ns = 0;
  std::int64_t gap_ns = 0;
  std::int64_t jitter_ns = 0;
  std::int64_t blocking_ns = 0;  // longest non-preemptive run of lower-priority work
};

struct ResponseTime {
  std::int64_t response_ns = 0;   // from the nominal release, jitter included
  std::int64_t preempted_ns = 0;  // part of it: preemption by higher-priority work
  int activations = 0;            // in the analysed busy period
};

namespace detail {

[[nodiscard]] constexpr std::int64_t ceil_of_quotient(std::int64_t a, std::int64_t b) {
  return a / b + (a % b > 0 ? 1 : 0);
}

[[nodiscard]] constexpr std::int64_t demand_ns(std::span<const Interference> higher,
                                               std::int64_t window_ns) {
  std::int64_t sum = 0;
  for (const Interference& i : higher) {
    if (i.cost_ns <= 0) continue;
    // A gap that was not declared counts as 1 ns, so that the cost is never hidden.
    const std::int64_t gap = i.gap_ns > 0 ? i.gap_ns : 1;
    sum += ceil_of_quotient(window_ns + i.jitter_ns, gap) * i.cost_ns;
  }
  return sum;
}

}  // namespace detail

// Smallest window that holds `base_ns` and all preemptions within it. The search starts at
// `from_ns`, a lower bound. Returns nothing beyond `limit_ns` or if the steps are used up.
[[nodiscard]] constexpr std::optional<std::int64_t> busy_window(
    std::int64_t base_ns, std::span<const Interference> higher, std::int64_t limit_ns,
    std::int64_t from_ns, int& steps_left) {
  std::int64_t window = from_ns > base_ns ? from_ns : base_ns;
  while (steps_left-- > 0) {
    const std::int64_t needed = base_ns + detail::demand_ns(higher, window);
    if (needed > limit_ns) return std::nullopt;
    if (needed <= window) return window;
    window = needed;
  }
  return std::nullopt;
}

// Returns nothing if no bound was found: the load is too high, or a maximum above was reached.
[[nodiscard]] constexpr std::optional<ResponseTime> response_time(
    const WorkUnderAnalysis& work, std::span<const Interference> higher) {
  int steps_left = k_response_steps_max;
  ResponseTime worst;
  std::int64_t window = 0;
  for (std::int64_t q = 0; steps_left > 0; ++q) {
    const std::int64_t base = work.blocking_ns + (q + 1) * work.cost_ns;
    const auto end = busy_window(base, higher, k_busy_period_max_ns, window, steps_left);
    if (!end) return std::nullopt;
    window = *end;
    ++worst.activations;
    const std::int64_t response = work.jitter_ns + window - q * work.gap_ns;
    if (response > worst.response_ns) {
      worst.response_ns = response;
      worst.preempted_ns = window - base;
    }
    // The next release comes after the end of this activation: the busy period is over.
    if (work.gap_ns <= 0 || window + work.jitter_ns <= (q + 1) * work.gap_ns) return worst;
  }
  return std::nullopt;
}

}  // namespace glint
