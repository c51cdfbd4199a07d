// Static schedule in the executor's form: allocation of nodes to workers and order per worker, with
// its validity check.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "graph/port.hpp"
#include "graph/wiring.hpp"

namespace glint::graph {

inline constexpr int k_plan_workers_max = 4;

// Bit i: node i of the execution order.
using NodeSet = std::uint64_t;

// Predecessors of each node: the nodes whose data it reads in the same activation.
template <class G>
inline constexpr auto predecessors = [] {
  using Wires = typename G::Wires;
  static_assert(Wires::node_count <= 64, "a set of nodes is one word");
  std::array<NodeSet, static_cast<std::size_t>(Wires::node_count)> sets{};
  for (const PortRow& port : Wires::ports) {
    if (port.kind != PortKind::read) continue;
    const int writer = Wires::writer[port.token];
    if (writer < 0) continue;
    const NodeSet copies = ((NodeSet{1} << Wires::copies[writer]) - 1) << Wires::first_node[writer];
    for (int copy = 0; copy < Wires::copies[port.unit]; ++copy) {
      sets[static_cast<std::size_t>(Wires::first_node[port.unit] + copy)] |= copies;
    }
  }
  return sets;
}();

template <class G>
struct ScheduleTables {
  static constexpr auto k_nodes = static_cast<std::size_t>(G::node_count);
  int workers = 1;
  std::array<std::uint8_t, k_nodes> worker{};  // of each node
  std::array<std::array<std::uint8_t, k_nodes>, k_plan_workers_max> order{};
  std::array<std::uint8_t, k_plan_workers_max> count{};

  // Appends the node to the worker's order. Returns false for an invalid node or worker, or without
  // room.
  constexpr bool add(int node, int on) noexcept {
    if (node < 0 || node >= G::node_count || on < 0 || on >= workers) return false;
    const auto w = static_cast<std::size_t>(on);
    if (count[w] >= k_nodes) return false;
    order[w][count[w]++] = static_cast<std::uint8_t>(node);
    worker[static_cast<std::size_t>(node)] = static_cast<std::uint8_t>(on);
    return true;
  }
  [[nodiscard]] constexpr NodeSet nodes_of(int of) const noexcept {
    NodeSet set = 0;
    const auto w = static_cast<std::size_t>(of);
    for (std::size_t i = 0; i < count[w]; ++i) set |= NodeSet{1} << order[w][i];
    return set;
  }
};

enum class PlanError : std::uint8_t {
  none,
  workers,       // fewer than 1 or more than k_plan_workers_max
  unknown_node,  // a number outside the graph
  ran_twice,
  left_out,
  first_node,  // node 0 is not the first of worker 0
  waits,       // deadlock: in this order the node never receives the data it reads
};
struct PlanFault {
  PlanError error = PlanError::none;
  int node = -1;
  [[nodiscard]] constexpr bool found() const noexcept { return error != PlanError::none; }
};

// Checks the tables: each node runs once, and the workers' orders together provide each node's
// data. Simulates the schedule without the nodes. Returns the first fault.
template <class G>
[[nodiscard]] constexpr PlanFault schedule_fault(const ScheduleTables<G>& tables) noexcept {
  if (tables.workers < 1 || tables.workers > k_plan_workers_max) return {PlanError::workers, -1};
  NodeSet listed = 0;
  for (int w = 0; w < tables.workers; ++w) {
    const auto i = static_cast<std::size_t>(w);
    for (std::size_t step = 0; step < std::min<std::size_t>(tables.count[i], tables.k_nodes);
         ++step) {
      const int node = tables.order[i][step];
      if (node >= G::node_count) return {PlanError::unknown_node, node};
      if ((listed >> node & 1u) != 0) return {PlanError::ran_twice, node};
      listed |= NodeSet{1} << node;
    }
  }
  for (int node = 0; node < G::node_count; ++node) {
    if ((listed >> node & 1u) == 0) return {PlanError::left_out, node};
  }
  if (tables.count[0] == 0 || tables.order[0][0] != 0) return {PlanError::first_node, 0};

  NodeSet run = 0;
  std::array<std::size_t, k_plan_workers_max> at{};
  for (int turn = 0; turn < G::node_count; ++turn) {
    bool moved = false;
    for (std::size_t w = 0; w < static_cast<std::size_t>(tables.workers); ++w) {
      if (at[w] == tables.count[w]) continue;
      const int node = tables.order[w][at[w]];
      if ((predecessors<G>[static_cast<std::size_t>(node)] & ~run) != 0) continue;
      run |= NodeSet{1} << node;
      ++at[w];
      moved = true;
    }
    if (moved) continue;
    for (std::size_t w = 0; w < static_cast<std::size_t>(tables.workers); ++w) {
      if (at[w] < tables.count[w]) return {PlanError::waits, tables.order[w][at[w]]};
    }
  }
  return {};
}

// Default schedule, without computed bounds: copy i of a split on worker i modulo the workers,
// every other node on worker 0, in the graph's order; as graph/workers.hpp between its barriers.
template <class G>
[[nodiscard]] constexpr ScheduleTables<G> default_schedule(int workers) noexcept {
  ScheduleTables<G> tables;
  tables.workers = std::clamp(workers, 1, k_plan_workers_max);
  for (const int unit : G::Wires::order.units) {
    for (int copy = 0; copy < G::Wires::copies[unit]; ++copy) {
      tables.add(G::Wires::first_node[unit] + copy, copy % tables.workers);
    }
  }
  return tables;
}

}  // namespace glint::graph
