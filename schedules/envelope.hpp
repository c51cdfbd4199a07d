// Upper envelope of observed execution costs: costs per loop iteration that no observed call
// exceeds, with the smallest bound (linear programming).
//
// What:     minimise w . c  subject to  n_i . c >= y_i for every observed call i,  c >= 0
//           with n_i the loop counts of call i, y_i its cost, and w the counts whose bound is to be
//           small. Then a declared margin is added to every cost.
// Cost:     the dual has one row a loop: at most k_pivots_max pivots, each one pass over the calls
//           and k_loops_max^2 products. Runs on a desktop, never on the run path.
// Worst:    degenerate pivots without progress: after k_stalls_max of them Bland's rule.
// Accuracy: every constraint holds exactly: rounding errors are removed by scaling the costs up.
// Source:   Dantzig, Orden, Wolfe 1955 (revised simplex, explicit inverse); Bland 1977, rule I.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "graph/loops.hpp"

namespace glint {

inline constexpr int k_pivots_max = 10'000;
inline constexpr int k_stalls_max = 50;

struct ObservedCall {
  graph::LoopCounts counts;
  double cost = 0;  // instructions or nanoseconds
};

using LoopWeights = std::array<double, graph::k_loops_max>;

// A problem size: its maximum loop counts, and its most expensive observed call.
struct ProblemSize {
  graph::LoopCounts maximum;
  double cost_max = 0;
};

// Weights that minimise the ratio of the bound to the most expensive call, equally at each size, so
// that a small problem counts as much as a large one. The average call has the weight of one size:
// without it the loop that always runs would receive all cost.
[[nodiscard]] LoopWeights balanced_weights(std::span<const ObservedCall> calls,
                                           std::span<const ProblemSize> sizes);

struct EnvelopeProblem {
  std::span<const ObservedCall> calls;
  LoopWeights weight{};  // w: counts whose bound is minimised
  int loops = 1;         // at most k_loops_max
  double margin = 0.05;  // 0.05: every cost is increased by 5 %
  int pivots_max = k_pivots_max;
  int stalls_max = k_stalls_max;
};

enum class EnvelopeFault : std::uint8_t { none, no_calls, cost_without_counts, pivots_exhausted };
[[nodiscard]] std::string_view name_of(EnvelopeFault fault);

struct Envelope {
  EnvelopeFault fault = EnvelopeFault::none;
  std::array<double, graph::k_loops_max> cost{};
  int pivots = 0;
  [[nodiscard]] explicit operator bool() const { return fault == EnvelopeFault::none; }
};

[[nodiscard]] Envelope fit_envelope(const EnvelopeProblem& problem);

[[nodiscard]] double cost_of(const Envelope& envelope, const graph::LoopCounts& counts);

// Validation of an envelope: number of calls above it, and the largest excess.
struct EnvelopeValidation {
  std::int64_t calls = 0;
  std::int64_t above = 0;
  double worst_excess_percent = 0;  // relative to the envelope; 0: no call is above
};
[[nodiscard]] EnvelopeValidation validate(const Envelope& envelope,
                                          std::span<const ObservedCall> calls);

}  // namespace glint
