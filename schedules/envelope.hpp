// Costs a count that no observed call exceeds, and that make the bound as small as that allows.
//
// What:     minimise w . c  subject to  n_i . c >= y_i for every observed call i,  c >= 0
//           where n_i are the loop counts of call i, y_i what it cost, and w the counts whose bound
//           matters. Then every cost is widened by a declared margin.
// Cost:     the dual has one row a loop: at most k_pivots_max pivots, each one pass over the calls
//           and k_loops_max^2 products. Made on a desktop, never on the run path.
// Worst:    calls that tie, so that pivots gain nothing: after k_stalls_max of them Bland's rule.
// Accuracy: every constraint holds in the result to its last bit: what rounding leaves is lifted.
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

// A size of problem: what its loops do at most, and the dearest call seen of it.
struct ProblemSize {
  graph::LoopCounts maximum;
  double dearest = 0;
};

// Weights that ask for a small ratio of bound to dearest call at each size, so that a small problem
// counts as much as a large one, and, as strongly as at one of them, at the calls on average:
// without the latter all cost would go to the loop that always runs.
[[nodiscard]] LoopWeights balanced_weights(std::span<const ObservedCall> calls,
                                           std::span<const ProblemSize> sizes);

struct EnvelopeProblem {
  std::span<const ObservedCall> calls;
  LoopWeights weight{};  // w: counts whose bound is minimised
  int loops = 1;         // at most k_loops_max
  double margin = 0.05;  // 0.05: every cost 5 % up
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

// How an envelope does on calls: how many cost more than it says, and the largest excess.
struct EnvelopeJudgement {
  std::int64_t calls = 0;
  std::int64_t above = 0;
  double worst_excess_percent = 0;  // of what the envelope says; 0: none is above
};
[[nodiscard]] EnvelopeJudgement judge(const Envelope& envelope,
                                      std::span<const ObservedCall> calls);

}  // namespace glint
