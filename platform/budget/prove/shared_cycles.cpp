#include "platform/budget/prove/shared_cycles.hpp"

#include <algorithm>

namespace glint::prove {
namespace {

using Mask = std::vector<bool>;

// Blocks of one cycle, and those of them that are entered from outside.
struct Cycle {
  std::vector<int> blocks, entries;
};

// Strongly connected components of the blocks in the mask: Tarjan 1972, with an explicit stack.
std::vector<std::vector<int>> components(const std::vector<Block>& blocks, const Mask& inside) {
  const std::size_t count = blocks.size();
  std::vector<int> number(count, -1), lowest(count, 0), stack;
  std::vector<std::size_t> next(count, 0);
  Mask on_stack(count, false);
  std::vector<std::vector<int>> found;
  int numbered = 0;
  for (std::size_t root = 0; root < count; ++root) {
    if (!inside[root] || number[root] >= 0) continue;
    std::vector<int> path = {static_cast<int>(root)};
    while (!path.empty()) {
      const auto at = static_cast<std::size_t>(path.back());
      if (number[at] < 0) {
        number[at] = lowest[at] = numbered++;
        stack.push_back(path.back());
        on_stack[at] = true;
      }
      if (next[at] < blocks[at].successors.size()) {
        const auto to = static_cast<std::size_t>(blocks[at].successors[next[at]++]);
        if (!inside[to]) continue;
        if (number[to] < 0) path.push_back(static_cast<int>(to));
        if (number[to] >= 0 && on_stack[to]) lowest[at] = std::min(lowest[at], number[to]);
        continue;
      }
      path.pop_back();
      if (!path.empty()) {
        int& above = lowest[static_cast<std::size_t>(path.back())];
        above = std::min(above, lowest[at]);
      }
      if (lowest[at] != number[at]) continue;
      std::vector<int>& component = found.emplace_back();
      for (bool whole = false; !whole; whole = component.back() == static_cast<int>(at)) {
        component.push_back(stack.back());
        on_stack[static_cast<std::size_t>(stack.back())] = false;
        stack.pop_back();
      }
    }
  }
  return found;
}

Mask mask_of(const std::vector<int>& numbers, std::size_t count) {
  Mask mask(count, false);
  for (const int number : numbers) mask[static_cast<std::size_t>(number)] = true;
  return mask;
}

// A cycle with several entries, the outermost first; empty if there is none.
Cycle shared_cycle(const std::vector<Block>& blocks) {
  const auto before = predecessors_of(blocks);
  std::vector<Mask> open = {Mask(blocks.size(), true)};
  while (!open.empty()) {
    const Mask searched = std::move(open.back());
    open.pop_back();
    for (const std::vector<int>& component : components(blocks, searched)) {
      if (component.size() < 2) continue;
      Mask inside = mask_of(component, blocks.size());
      Cycle cycle{component, {}};
      for (const int block : component) {
        const auto& from = before[static_cast<std::size_t>(block)];
        const bool entered = block == 0 || std::any_of(from.begin(), from.end(), [&](int one) {
                               return !inside[static_cast<std::size_t>(one)];
                             });
        if (entered) cycle.entries.push_back(block);
      }
      if (cycle.entries.size() > 1) return cycle;
      for (const int entry : cycle.entries) inside[static_cast<std::size_t>(entry)] = false;
      open.push_back(std::move(inside));  // the cycles inside, without this one's header
    }
  }
  return {};
}

// Blocks of the cycle that its other entries reach without the header.
std::vector<int> copied(const std::vector<Block>& blocks, const Cycle& cycle, int header) {
  const Mask inside = mask_of(cycle.blocks, blocks.size());
  Mask seen(blocks.size(), false);
  std::vector<int> reached, open = cycle.entries;
  while (!open.empty()) {
    const int at = open.back();
    open.pop_back();
    const auto index = static_cast<std::size_t>(at);
    if (at == header || !inside[index] || seen[index]) continue;
    seen[index] = true;
    reached.push_back(at);
    for (const int to : blocks[index].successors) open.push_back(to);
  }
  return reached;
}

// The header becomes the only entry of the cycle: other entries lead to copies.
void give_one_entry(std::vector<Block>& blocks, const Cycle& cycle,
                    const std::vector<int>& copies) {
  const std::size_t count = blocks.size();
  const Mask inside = mask_of(cycle.blocks, count);
  std::vector<int> copy_of(count, -1);
  for (std::size_t i = 0; i < copies.size(); ++i) {
    copy_of[static_cast<std::size_t>(copies[i])] = static_cast<int>(count + i);
  }
  const auto lead_to_copies = [&](Block& block) {
    for (int& to : block.successors) {
      const int copy = copy_of[static_cast<std::size_t>(to)];
      if (copy >= 0) to = copy;
    }
  };
  for (const int original : copies) {
    Block copy = blocks[static_cast<std::size_t>(original)];
    lead_to_copies(copy);
    blocks.push_back(std::move(copy));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!inside[i]) lead_to_copies(blocks[i]);
  }
}

// Removes blocks that nothing leads to any more.
void remove_unreached(std::vector<Block>& blocks) {
  std::vector<int> new_number(blocks.size(), -1), open = {0};
  while (!open.empty()) {
    const auto at = static_cast<std::size_t>(open.back());
    open.pop_back();
    if (new_number[at] >= 0) continue;
    new_number[at] = 0;
    for (const int to : blocks[at].successors) open.push_back(to);
  }
  std::vector<Block> kept;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (new_number[i] < 0) continue;
    new_number[i] = static_cast<int>(kept.size());
    kept.push_back(std::move(blocks[i]));
  }
  for (Block& block : kept) {
    for (int& to : block.successors) to = new_number[static_cast<std::size_t>(to)];
  }
  blocks = std::move(kept);
}

}  // namespace

bool split_shared_cycles(std::vector<Block>& blocks) {
  for (Cycle cycle = shared_cycle(blocks); !cycle.blocks.empty(); cycle = shared_cycle(blocks)) {
    std::vector<int> fewest;
    for (const int header : cycle.entries) {
      if (header == 0) {  // the function's entry is no copy
        fewest = copied(blocks, cycle, header);
        break;
      }
      std::vector<int> copies = copied(blocks, cycle, header);
      if (fewest.empty() || copies.size() < fewest.size()) fewest = std::move(copies);
    }
    if (blocks.size() + fewest.size() > k_blocks_max) return false;
    give_one_entry(blocks, cycle, fewest);
    remove_unreached(blocks);
  }
  return true;
}

}  // namespace glint::prove
