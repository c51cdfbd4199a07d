#include <algorithm>
#include <map>

#include "platform/budget/prove/function_graph.hpp"

namespace glint::prove {
namespace {

std::vector<int> reverse_postorder(const std::vector<Block>& blocks) {
  std::vector<int> order;
  std::vector<std::size_t> next(blocks.size(), 0);
  std::vector<bool> seen(blocks.size(), false);
  std::vector<int> path = {0};
  seen[0] = true;
  while (!path.empty()) {
    const auto block = static_cast<std::size_t>(path.back());
    if (next[block] == blocks[block].successors.size()) {
      order.push_back(path.back());
      path.pop_back();
      continue;
    }
    const int to = blocks[block].successors[next[block]++];
    if (!seen[static_cast<std::size_t>(to)]) {
      seen[static_cast<std::size_t>(to)] = true;
      path.push_back(to);
    }
  }
  std::reverse(order.begin(), order.end());
  return order;
}

}  // namespace

std::vector<std::vector<int>> predecessors_of(const std::vector<Block>& blocks) {
  std::vector<std::vector<int>> before(blocks.size());
  for (std::size_t from = 0; from < blocks.size(); ++from) {
    for (const int to : blocks[from].successors) {
      before[static_cast<std::size_t>(to)].push_back(static_cast<int>(from));
    }
  }
  return before;
}

std::vector<int> dominators(const std::vector<Block>& blocks) {
  const std::vector<int> order = reverse_postorder(blocks);
  std::vector<int> rank(blocks.size(), -1), immediate(blocks.size(), -1);
  for (std::size_t i = 0; i < order.size(); ++i) {
    rank[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
  }
  const auto before = predecessors_of(blocks);
  const auto of = [&](int block) -> int& { return immediate[static_cast<std::size_t>(block)]; };
  const auto common = [&](int a, int b) {
    while (a != b) {
      while (rank[static_cast<std::size_t>(a)] > rank[static_cast<std::size_t>(b)]) a = of(a);
      while (rank[static_cast<std::size_t>(b)] > rank[static_cast<std::size_t>(a)]) b = of(b);
    }
    return a;
  };
  of(0) = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (const int block : order) {
      if (block == 0) continue;
      int found = -1;
      for (const int from : before[static_cast<std::size_t>(block)]) {
        if (of(from) != -1) found = found == -1 ? from : common(found, from);
      }
      changed = changed || of(block) != found;
      of(block) = found;
    }
  }
  return immediate;
}

bool dominates(const std::vector<int>& immediate, int above, int below) {
  while (below != above && below != 0) below = immediate[static_cast<std::size_t>(below)];
  return below == above;
}

void find_loops(FunctionGraph& graph) {
  graph.loops.clear();
  if (graph.blocks.empty()) return;
  const std::vector<int> immediate = dominators(graph.blocks);
  const std::vector<int> order = reverse_postorder(graph.blocks);
  std::vector<int> rank(graph.blocks.size(), 0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    rank[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
  }
  std::map<int, Loop> by_header;
  for (const int from : order) {
    for (const int to : graph.blocks[static_cast<std::size_t>(from)].successors) {
      if (dominates(immediate, to, from)) {
        by_header[to].header = to;
        by_header[to].latches.push_back(from);
      } else if (rank[static_cast<std::size_t>(to)] <= rank[static_cast<std::size_t>(from)]) {
        graph.refusals.push_back({graph.blocks[static_cast<std::size_t>(to)].address,
                                  "a cycle with more than one entry"});
      }
    }
  }
  const auto before = predecessors_of(graph.blocks);
  for (auto& [header, loop] : by_header) {
    std::vector<bool> inside(graph.blocks.size(), false);
    inside[static_cast<std::size_t>(header)] = true;
    loop.blocks = {header};
    std::vector<int> open = loop.latches;
    while (!open.empty()) {
      const int block = open.back();
      open.pop_back();
      if (inside[static_cast<std::size_t>(block)]) continue;
      inside[static_cast<std::size_t>(block)] = true;
      loop.blocks.push_back(block);
      for (const int from : before[static_cast<std::size_t>(block)]) open.push_back(from);
    }
    graph.loops.push_back(loop);
  }
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    std::size_t smallest = graph.blocks.size() + 1;
    for (std::size_t k = 0; k < graph.loops.size(); ++k) {
      const std::vector<int>& around = graph.loops[k].blocks;
      if (k == i || around.size() >= smallest) continue;
      if (std::find(around.begin(), around.end(), graph.loops[i].header) == around.end()) continue;
      smallest = around.size();
      graph.loops[i].parent = static_cast<int>(k);
    }
  }
}

}  // namespace glint::prove
