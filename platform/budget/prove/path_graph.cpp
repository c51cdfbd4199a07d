#include "platform/budget/prove/path_graph.hpp"

#include <sstream>

#include "platform/budget/prove/function_graph.hpp"

namespace glint::prove {

std::string text_of(const PathGraph& graph) {
  std::ostringstream text;
  text << "glint path graph 1\nkernel " << graph.kernel << "\nmachine " << graph.machine
       << "\ncode " << graph.code_sha256 << "\n";
  for (const std::string& function : graph.functions) text << "function " << function << "\n";
  for (const PathBlock& block : graph.blocks) {
    text << "block " << block.function << " " << block.cost << " " << block.callee
         << (block.leaves ? " leaves 0x" : " stays 0x") << std::hex << block.address << std::dec
         << " " << (block.place.empty() ? "-" : block.place) << "\n";
  }
  for (const auto& [from, to] : graph.edges) text << "edge " << from << " " << to << "\n";
  for (const PathLoop& loop : graph.loops) {
    text << "loop " << loop.header << " " << loop.at_most << "\n";
  }
  for (const PathTotal& total : graph.totals) {
    text << (total.of == PathTotal::Of::runs ? "runs " : "total ") << total.at_most;
    text << " " << total.scope;
    for (const int block : total.blocks) text << " " << block;
    text << "\n";
  }
  return text.str();
}

EdgeRoles roles_of(const PathGraph& graph) {
  EdgeRoles roles;
  roles.edges.assign(graph.edges.size(), EdgeRole::plain);
  roles.entries.assign(graph.functions.size(), EdgeRole::plain);
  roles.loop_of_block.assign(graph.blocks.size(), -1);
  roles.entry_of_function.assign(graph.functions.size(), -1);
  for (std::size_t loop = 0; loop < graph.loops.size(); ++loop) {
    roles.loop_of_block[static_cast<std::size_t>(graph.loops[loop].header)] =
        static_cast<int>(loop);
  }
  // The blocks of one function at a time, numbered from 0 for the dominators.
  std::vector<int> first(graph.functions.size(), -1);
  std::vector<std::vector<Block>> blocks(graph.functions.size());
  for (std::size_t i = 0; i < graph.blocks.size(); ++i) {
    const auto function = static_cast<std::size_t>(graph.blocks[i].function);
    if (first[function] < 0) first[function] = static_cast<int>(i);
    blocks[function].emplace_back();
  }
  const auto function_of = [&](int block) {
    return static_cast<std::size_t>(graph.blocks[static_cast<std::size_t>(block)].function);
  };
  for (const auto& [from, to] : graph.edges) {
    const std::size_t function = function_of(from);
    blocks[function][static_cast<std::size_t>(from - first[function])].successors.push_back(
        to - first[function]);
  }
  for (std::size_t function = 0; function < blocks.size(); ++function) {
    const std::vector<int> immediate = dominators(blocks[function]);
    roles.entry_of_function[function] = first[function];
    const bool is_header = roles.loop_of_block[static_cast<std::size_t>(first[function])] >= 0;
    if (is_header) roles.entries[function] = EdgeRole::enters;
    for (std::size_t edge = 0; edge < graph.edges.size(); ++edge) {
      const auto [from, to] = graph.edges[edge];
      if (function_of(from) != function) continue;
      if (roles.loop_of_block[static_cast<std::size_t>(to)] < 0) continue;
      roles.edges[edge] = dominates(immediate, to - first[function], from - first[function])
                              ? EdgeRole::jumps_back
                              : EdgeRole::enters;
    }
  }
  return roles;
}

}  // namespace glint::prove
