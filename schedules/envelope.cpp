#include "schedules/envelope.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr std::size_t k_rows = graph::k_loops_max;
constexpr double k_tolerance = 1e-9;  // of quantities scaled to about 1

using Row = std::array<double, k_rows>;

// The dual: maximise y . l  subject to  sum_i n_i l_i <= w,  l >= 0. Its columns are the calls and
// one slack variable per loop. Its multipliers are the costs, feasible once no column improves.
class DualSimplexTable {
 public:
  explicit DualSimplexTable(const EnvelopeProblem& problem) : problem_(problem) {
    for (std::size_t j = 0; j < loops(); ++j) scale_[j] = 1;
    for (const ObservedCall& call : problem.calls) {
      cost_scale_ = std::max(cost_scale_, call.cost);
      for (std::size_t j = 0; j < loops(); ++j) {
        scale_[j] = std::max(scale_[j], static_cast<double>(call.counts[j]));
      }
    }
    if (!(cost_scale_ > 0)) cost_scale_ = 1;
    double weight_max = 0;
    for (std::size_t j = 0; j < loops(); ++j) {
      weight_max = std::max(weight_max, problem.weight[j] / scale_[j]);
    }
    if (weight_max == 0) weight_max = 1;
    for (std::size_t j = 0; j < loops(); ++j) {
      basis_[j] = slack(j);
      inverse_[j][j] = 1;
      value_[j] = problem.weight[j] / scale_[j] / weight_max;
    }
  }

  EnvelopeFault solve(int& pivots) {
    int stalls = 0;
    for (pivots = 0; pivots < problem_.pivots_max; ++pivots) {
      find_multipliers();
      const bool stalled = stalls > problem_.stalls_max;
      const std::int64_t entering = stalled ? first_improving() : best_improving();
      if (entering < 0) return EnvelopeFault::none;
      const Row direction = times_inverse(column(entering));
      const int leaving = row_that_blocks(direction);
      // A call with cost but without any count: no cost per count can cover it.
      if (leaving < 0) return EnvelopeFault::cost_without_counts;
      const auto row = static_cast<std::size_t>(leaving);
      stalls = value_[row] / direction[row] > k_tolerance ? 0 : stalls + 1;
      pivot(row, direction, entering);
    }
    return EnvelopeFault::pivots_exhausted;
  }

  [[nodiscard]] double cost(std::size_t loop) const {
    return std::max(0.0, multiplier_[loop]) * cost_scale_ / scale_[loop];
  }

 private:
  [[nodiscard]] std::size_t loops() const { return static_cast<std::size_t>(problem_.loops); }
  [[nodiscard]] std::int64_t slack(std::size_t loop) const {
    return static_cast<std::int64_t>(problem_.calls.size() + loop);
  }
  [[nodiscard]] bool is_call(std::int64_t index) const {
    return index < static_cast<std::int64_t>(problem_.calls.size());
  }
  [[nodiscard]] Row column(std::int64_t index) const {
    Row result{};
    if (is_call(index)) {
      const ObservedCall& call = problem_.calls[static_cast<std::size_t>(index)];
      for (std::size_t j = 0; j < loops(); ++j) {
        result[j] = static_cast<double>(call.counts[j]) / scale_[j];
      }
    } else {
      result[static_cast<std::size_t>(index) - problem_.calls.size()] = 1;
    }
    return result;
  }
  [[nodiscard]] double gain(std::int64_t index) const {
    return is_call(index) ? problem_.calls[static_cast<std::size_t>(index)].cost / cost_scale_ : 0;
  }

  // c = y_B B^-1.
  void find_multipliers() {
    multiplier_ = {};
    for (std::size_t i = 0; i < loops(); ++i) {
      const double y = gain(basis_[i]);
      for (std::size_t j = 0; j < loops(); ++j) multiplier_[j] += y * inverse_[i][j];
    }
  }
  [[nodiscard]] double improvement(std::int64_t index) const {
    const Row n = column(index);
    double sum = gain(index);
    for (std::size_t j = 0; j < loops(); ++j) sum -= n[j] * multiplier_[j];
    return sum;
  }
  [[nodiscard]] std::int64_t columns() const { return slack(loops()); }
  [[nodiscard]] std::int64_t best_improving() const {
    std::int64_t best = -1;
    double most = k_tolerance;
    for (std::int64_t i = 0; i < columns(); ++i) {
      const double improves = improvement(i);
      if (improves > most) {
        most = improves;
        best = i;
      }
    }
    return best;
  }
  [[nodiscard]] std::int64_t first_improving() const {
    for (std::int64_t i = 0; i < columns(); ++i) {
      if (improvement(i) > k_tolerance) return i;
    }
    return -1;
  }
  [[nodiscard]] Row times_inverse(const Row& n) const {
    Row result{};
    for (std::size_t i = 0; i < loops(); ++i) {
      for (std::size_t j = 0; j < loops(); ++j) result[i] += inverse_[i][j] * n[j];
    }
    return result;
  }
  // Ratio test; ties are broken by the smallest column index (Bland).
  [[nodiscard]] int row_that_blocks(const Row& direction) const {
    int best = -1;
    double least = 0;
    for (std::size_t i = 0; i < loops(); ++i) {
      if (direction[i] <= k_tolerance) continue;
      const double ratio = value_[i] / direction[i];
      const bool first = best < 0;
      const bool ties = !first && ratio == least;
      if (first || ratio < least || (ties && basis_[i] < basis_[static_cast<std::size_t>(best)])) {
        best = static_cast<int>(i);
        least = ratio;
      }
    }
    return best;
  }
  void pivot(std::size_t row, const Row& direction, std::int64_t entering) {
    for (std::size_t j = 0; j < loops(); ++j) inverse_[row][j] /= direction[row];
    value_[row] /= direction[row];
    for (std::size_t i = 0; i < loops(); ++i) {
      if (i == row) continue;
      for (std::size_t j = 0; j < loops(); ++j) inverse_[i][j] -= direction[i] * inverse_[row][j];
      value_[i] = std::max(0.0, value_[i] - direction[i] * value_[row]);
    }
    basis_[row] = entering;
  }

  const EnvelopeProblem& problem_;
  double cost_scale_ = 0;
  Row scale_{};  // the largest count of each loop, at least 1
  std::array<std::int64_t, k_rows> basis_{};
  std::array<Row, k_rows> inverse_{};
  Row value_{};
  Row multiplier_{};
};

}  // namespace

std::string_view name_of(EnvelopeFault fault) {
  constexpr std::string_view names[] = {"none", "no calls",
                                        "a call costs something, but no loop ran",
                                        "no optimum within the declared pivots"};
  return names[static_cast<std::uint8_t>(fault) & 3];
}

LoopWeights balanced_weights(std::span<const ObservedCall> calls,
                             std::span<const ProblemSize> sizes) {
  LoopWeights weights{};
  for (const ObservedCall& call : calls) {
    if (!(call.cost > 0)) continue;
    for (std::size_t j = 0; j < k_rows; ++j) {
      weights[j] +=
          static_cast<double>(call.counts[j]) / call.cost / static_cast<double>(calls.size());
    }
  }
  for (const ProblemSize& size : sizes) {
    if (!(size.cost_max > 0)) continue;
    for (std::size_t j = 0; j < k_rows; ++j) {
      weights[j] += static_cast<double>(size.maximum[j]) / size.cost_max;
    }
  }
  return weights;
}

double cost_of(const Envelope& envelope, const graph::LoopCounts& counts) {
  double sum = 0;
  for (std::size_t j = 0; j < k_rows; ++j) {
    sum += envelope.cost[j] * static_cast<double>(counts[j]);
  }
  return sum;
}

Envelope fit_envelope(const EnvelopeProblem& problem) {
  Envelope envelope;
  if (problem.calls.empty()) {
    envelope.fault = EnvelopeFault::no_calls;
    return envelope;
  }
  DualSimplexTable table(problem);
  envelope.fault = table.solve(envelope.pivots);
  if (!envelope) return envelope;
  for (std::size_t j = 0; j < static_cast<std::size_t>(problem.loops); ++j) {
    envelope.cost[j] = table.cost(j);
  }
  double lift = 1;
  for (const ObservedCall& call : problem.calls) {
    const double bound = cost_of(envelope, call.counts);
    if (bound < call.cost && bound > 0) lift = std::max(lift, call.cost / bound);
  }
  for (double& cost : envelope.cost) cost *= lift * (1 + problem.margin);
  return envelope;
}

EnvelopeValidation validate(const Envelope& envelope, std::span<const ObservedCall> calls) {
  EnvelopeValidation result;
  result.calls = static_cast<std::int64_t>(calls.size());
  for (const ObservedCall& call : calls) {
    const double bound = cost_of(envelope, call.counts);
    if (call.cost <= bound) continue;
    ++result.above;
    const double excess = bound > 0 ? (call.cost / bound - 1) * 100 : 100;
    result.worst_excess_percent = std::max(result.worst_excess_percent, excess);
  }
  return result;
}

}  // namespace glint
