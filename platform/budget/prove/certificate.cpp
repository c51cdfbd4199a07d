#include "platform/budget/prove/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "platform/budget/prove/exact.hpp"

namespace glint::prove {
namespace {

constexpr std::int64_t k_unreached = std::numeric_limits<std::int64_t>::min();

std::vector<std::int64_t> rounded_up(const std::vector<double>& multipliers) {
  std::vector<std::int64_t> whole;
  for (const double multiplier : multipliers) {
    const double near = std::round(multiplier);
    const bool is_whole = std::abs(multiplier - near) < 1e-6 * std::max(1.0, std::abs(near));
    if (!(multiplier < 9e15)) throw std::runtime_error("a multiplier above 2^53");
    whole.push_back(std::max<std::int64_t>(
        0, static_cast<std::int64_t>(is_whole ? near : std::ceil(multiplier))));
  }
  return whole;
}

class Potentials {
 public:
  Potentials(const PathGraph& graph, Certificate& certificate)
      : graph_(graph), roles_(roles_of(graph)), certificate_(certificate) {
    total_of_jump_.assign(graph.blocks.size(), 0);
    total_of_run_ = total_of_entry_ = total_of_jump_;
    for (std::size_t i = 0; i < graph.totals.size(); ++i) {
      const PathTotal& total = graph.totals[i];
      auto& shares = total.of == PathTotal::Of::runs ? total_of_run_ : total_of_jump_;
      for (const int block : total.blocks) {
        std::int64_t& share = shares[static_cast<std::size_t>(block)];
        share = exact_sum(share, certificate.totals[i]);
      }
      if (total.scope < 0) continue;
      std::int64_t& paid = total_of_entry_[static_cast<std::size_t>(total.scope)];
      paid = exact_sum(paid, exact_product(certificate.totals[i], total.at_most));
    }
    leaving_.resize(graph.functions.size());
    for (std::size_t edge = 0; edge < graph.edges.size(); ++edge) {
      const auto from = static_cast<std::size_t>(graph.edges[edge].first);
      leaving_[static_cast<std::size_t>(graph.blocks[from].function)].push_back(edge);
    }
  }

  // Callees come before their callers, so one pass over the functions is enough.
  void compute() {
    certificate_.blocks.assign(graph_.blocks.size(), k_unreached);
    certificate_.functions.assign(graph_.functions.size(), 0);
    for (std::size_t function = 0; function < graph_.functions.size(); ++function) {
      for (const int header : headers_inside_out(function)) bound_loop(header);
      relax(function);
      const int entry = roles_.entry_of_function[function];
      const std::int64_t after = certificate_.blocks[static_cast<std::size_t>(entry)];
      if (after == k_unreached)
        throw std::runtime_error(graph_.functions[function] + " never ends");
      certificate_.functions[function] = exact_sum(cost(entry, roles_.entries[function]), after);
    }
    std::replace(certificate_.blocks.begin(), certificate_.blocks.end(), k_unreached,
                 std::int64_t{0});
  }

 private:
  // Cost of an edge into the block, less its share of the multipliers.
  std::int64_t cost(int to, EdgeRole role) const {
    const auto index = static_cast<std::size_t>(to);
    const PathBlock& block = graph_.blocks[index];
    std::int64_t sum = block.cost;
    if (block.callee >= 0) {
      sum = exact_sum(sum, certificate_.functions[static_cast<std::size_t>(block.callee)]);
    }
    sum = exact_sum(sum, -total_of_run_[index]);
    if (role == EdgeRole::plain) return sum;
    const auto loop = static_cast<std::size_t>(roles_.loop_of_block[index]);
    const std::int64_t multiplier = certificate_.loops[loop];
    if (role == EdgeRole::enters) {
      sum = exact_sum(sum, total_of_entry_[index]);
      return exact_sum(sum, exact_product(multiplier, graph_.loops[loop].at_most));
    }
    return exact_sum(sum, -exact_sum(multiplier, total_of_jump_[index]));
  }

  std::vector<bool> blocks_of_loop(int header) const {
    std::vector<bool> inside(graph_.blocks.size(), false);
    inside[static_cast<std::size_t>(header)] = true;
    const auto& edges = leaving_[static_cast<std::size_t>(
        graph_.blocks[static_cast<std::size_t>(header)].function)];
    for (bool changed = true; changed;) {
      changed = false;
      for (const std::size_t edge : edges) {
        const auto [from, to] = graph_.edges[edge];
        const bool leads_inside = to == header ? roles_.edges[edge] == EdgeRole::jumps_back
                                               : inside[static_cast<std::size_t>(to)];
        if (!leads_inside || inside[static_cast<std::size_t>(from)]) continue;
        inside[static_cast<std::size_t>(from)] = changed = true;
      }
    }
    return inside;
  }

  // A loop inside another has fewer blocks.
  std::vector<int> headers_inside_out(std::size_t function) const {
    std::vector<std::pair<std::ptrdiff_t, int>> headers;
    for (const PathLoop& loop : graph_.loops) {
      if (graph_.blocks[static_cast<std::size_t>(loop.header)].function !=
          static_cast<int>(function)) {
        continue;
      }
      const std::vector<bool> inside = blocks_of_loop(loop.header);
      headers.emplace_back(std::count(inside.begin(), inside.end(), true), loop.header);
    }
    std::sort(headers.begin(), headers.end());
    std::vector<int> order;
    for (const auto& [size, header] : headers) order.push_back(header);
    return order;
  }

  // The smallest multiplier is the longest way around the loop, if all loops inside have theirs.
  void bound_loop(int header) {
    const std::vector<bool> inside = blocks_of_loop(header);
    std::vector<std::int64_t> around(graph_.blocks.size(), k_unreached);
    const auto& edges = leaving_[static_cast<std::size_t>(
        graph_.blocks[static_cast<std::size_t>(header)].function)];
    for (bool changed = true; changed;) {
      changed = false;
      for (auto edge = edges.rbegin(); edge != edges.rend(); ++edge) {
        const auto [from, to] = graph_.edges[*edge];
        if (!inside[static_cast<std::size_t>(from)] || !inside[static_cast<std::size_t>(to)]) {
          continue;
        }
        const std::int64_t after = to == header ? 0 : around[static_cast<std::size_t>(to)];
        if (after == k_unreached) continue;
        const std::int64_t before = exact_sum(cost(to, roles_.edges[*edge]), after);
        std::int64_t& longest = around[static_cast<std::size_t>(from)];
        changed = changed || before > longest;
        longest = std::max(longest, before);
      }
    }
    const auto loop =
        static_cast<std::size_t>(roles_.loop_of_block[static_cast<std::size_t>(header)]);
    certificate_.loops[loop] = std::max<std::int64_t>(0, around[static_cast<std::size_t>(header)]);
  }

  // Longest distance from each block to the function's end: Bellman and Ford.
  void relax(std::size_t function) {
    std::size_t blocks = 0;
    for (std::size_t i = 0; i < graph_.blocks.size(); ++i) {
      if (graph_.blocks[i].function != static_cast<int>(function)) continue;
      ++blocks;
      if (graph_.blocks[i].leaves) certificate_.blocks[i] = 0;
    }
    for (std::size_t round = 0; round <= blocks; ++round) {
      bool changed = false;
      for (auto edge = leaving_[function].rbegin(); edge != leaving_[function].rend(); ++edge) {
        const auto [from, to] = graph_.edges[*edge];
        const std::int64_t after = certificate_.blocks[static_cast<std::size_t>(to)];
        if (after == k_unreached) continue;
        const std::int64_t before = exact_sum(cost(to, roles_.edges[*edge]), after);
        std::int64_t& potential = certificate_.blocks[static_cast<std::size_t>(from)];
        changed = changed || before > potential;
        potential = std::max(potential, before);
      }
      if (!changed) return;
    }
    throw std::runtime_error(graph_.functions[function] + ": the multipliers do not bound a loop");
  }

  const PathGraph& graph_;
  EdgeRoles roles_;
  Certificate& certificate_;
  std::vector<std::int64_t> total_of_jump_, total_of_run_, total_of_entry_;  // by block
  std::vector<std::vector<std::size_t>> leaving_;                            // edges by function
};

}  // namespace

Certificate certificate_of(const PathGraph& graph, const PathSolution& solution) {
  Certificate certificate;
  certificate.loops.assign(graph.loops.size(), 0);
  certificate.totals = rounded_up(solution.totals);
  Potentials(graph, certificate).compute();
  certificate.bound = certificate.functions.back();
  for (std::size_t total = 0; total < graph.totals.size(); ++total) {
    if (graph.totals[total].scope >= 0) continue;
    certificate.bound = exact_sum(
        certificate.bound, exact_product(certificate.totals[total], graph.totals[total].at_most));
  }
  return certificate;
}

std::string text_of(const Certificate& certificate, const std::string& graph_sha256) {
  std::string text = "glint path certificate 1\ngraph " + graph_sha256 + "\nbound " +
                     std::to_string(certificate.bound) + "\n";
  const auto add = [&](const char* kind, const std::vector<std::int64_t>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] == 0) continue;
      text += std::string(kind) + " " + std::to_string(i) + " " + std::to_string(values[i]) + "\n";
    }
  };
  add("block", certificate.blocks);
  add("function", certificate.functions);
  add("loop", certificate.loops);
  add("total", certificate.totals);
  return text;
}

}  // namespace glint::prove
