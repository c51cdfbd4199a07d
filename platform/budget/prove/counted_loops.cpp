#include "platform/budget/prove/counted_loops.hpp"

#include <algorithm>

namespace glint::prove {
namespace {

constexpr std::int64_t k_counter_max = std::int64_t{1} << 31;
constexpr std::int64_t k_jumps_max = std::int64_t{1} << 40;

Condition opposite_of(Condition condition) {
  switch (condition) {
    case Condition::equal:
      return Condition::not_equal;
    case Condition::not_equal:
      return Condition::equal;
    case Condition::less:
      return Condition::greater_equal;
    case Condition::less_equal:
      return Condition::greater;
    case Condition::greater:
      return Condition::less_equal;
    case Condition::greater_equal:
      return Condition::less;
    case Condition::below:
      return Condition::above_equal;
    case Condition::below_equal:
      return Condition::above;
    case Condition::above:
      return Condition::below_equal;
    case Condition::above_equal:
      return Condition::below;
    case Condition::unknown:
      break;
  }
  return Condition::unknown;
}

// One side of a test: its value in pass k is first + k * step.
struct Side {
  RegisterValue first;  // before the first pass
  std::int64_t step = 0;
};

class Counting {
 public:
  Counting(const FunctionGraph& graph, const Loop& loop, const RegisterValues& values)
      : graph_(graph), loop_(loop), values_(values) {}

  std::optional<std::int64_t> jumps_back() const {
    if (loop_.header == 0) return std::nullopt;  // the function's entry has no block before it
    std::optional<std::int64_t> least;
    for (const int block : loop_.blocks) {
      if (!runs_once_a_pass(block)) continue;
      const std::optional<std::int64_t> count = of_test(block);
      if (count && (!least || *count < *least)) least = count;
    }
    return least;
  }

 private:
  [[nodiscard]] bool is_inside(int block) const {
    return std::find(loop_.blocks.begin(), loop_.blocks.end(), block) != loop_.blocks.end();
  }

  [[nodiscard]] bool runs_once_a_pass(int block) const {
    const auto is_above = [&](int latch) { return values_.dominates(block, latch); };
    if (!std::all_of(loop_.latches.begin(), loop_.latches.end(), is_above)) return false;
    return std::none_of(graph_.loops.begin(), graph_.loops.end(), [&](const Loop& inner) {
      return inner.header != loop_.header && is_inside(inner.header) &&
             std::find(inner.blocks.begin(), inner.blocks.end(), block) != inner.blocks.end();
    });
  }

  // Side of the test before the loop's first pass, entered from `before`.
  [[nodiscard]] std::optional<Side> side_of(const RegisterSum& sum, int block, std::size_t index,
                                            int before) const {
    Side side;
    const RegisterValue in_pass = values_.before(sum, block, index, loop_.header);
    side.first = in_pass;
    if (in_pass.origin == Origin::none || in_pass.origin == Origin::loaded) return side;
    if (in_pass.origin != Origin::start) return std::nullopt;
    side.first = values_.at_end(in_pass.base, before);
    side.first.offset += in_pass.offset;
    side.first.narrow = side.first.narrow || in_pass.narrow;
    for (const int latch : loop_.latches) {
      const RegisterValue next = values_.at_end(in_pass.base, latch, loop_.header);
      if (next.origin != Origin::start || next.base != in_pass.base) return std::nullopt;
      if (latch != loop_.latches.front() && next.offset != side.step) return std::nullopt;
      side.step = next.offset;
      side.first.narrow = side.first.narrow || next.narrow;
    }
    return side;
  }

  [[nodiscard]] std::optional<std::int64_t> of_test(int number) const {
    const Block& block = graph_.blocks[static_cast<std::size_t>(number)];
    if (block.instructions.empty() || block.successors.size() != 2) return std::nullopt;
    const Instruction& branch = block.instructions.back();
    if (branch.flow != Flow::branch || !branch.target) return std::nullopt;
    const bool first_inside = is_inside(block.successors[0]);
    if (first_inside == is_inside(block.successors[1])) return std::nullopt;
    const int inside = block.successors[first_inside ? 0 : 1];
    const bool jumps = graph_.blocks[static_cast<std::size_t>(inside)].address == *branch.target;
    const Condition continues = jumps ? branch.condition : opposite_of(branch.condition);

    std::size_t index = block.instructions.size() - 1;
    if (!branch.compares) {
      while (index > 0 && !block.instructions[index - 1].sets_flags) --index;
      if (index-- == 0) return std::nullopt;
    }
    const std::optional<Comparison>& compares = block.instructions[index].compares;
    if (!compares) return std::nullopt;
    std::optional<std::int64_t> most;
    for (const int before : values_.predecessors(loop_.header)) {
      if (is_inside(before)) continue;
      const auto left = side_of(compares->left, number, index, before);
      const auto right = side_of(compares->right, number, index, before);
      if (!left || !right) return std::nullopt;
      const auto count = passes(*left, *right, continues, *compares);
      if (!count) return std::nullopt;
      most = std::max(most.value_or(0), *count);
    }
    return most;
  }

  // Number of the first pass whose test ends the loop.
  static std::optional<std::int64_t> passes(const Side& left, const Side& right,
                                            Condition continues, const Comparison& compares) {
    if (!left.first.same_origin(right.first)) return std::nullopt;
    const bool constant = left.first.origin == Origin::none;
    const std::int64_t difference = left.first.offset - right.first.offset;
    const std::int64_t step = left.step - right.step;
    const auto in_range = [&](std::int64_t count) {
      const auto fits = [&](const Side& side) {
        const std::int64_t last = side.first.offset + side.step * count;
        return side.first.offset >= 0 && side.first.offset < k_counter_max && last >= 0 &&
               last < k_counter_max;
      };
      return constant && fits(left) && fits(right);
    };
    std::int64_t count = 0;
    if (continues == Condition::not_equal) {
      if (step == 0 || difference % step != 0) return std::nullopt;
      count = -difference / step;
    } else if (compares.only_equality) {
      return std::nullopt;
    } else {
      const bool less = continues == Condition::less || continues == Condition::below ||
                        continues == Condition::less_equal || continues == Condition::below_equal;
      const bool equal_too =
          continues == Condition::less_equal || continues == Condition::below_equal ||
          continues == Condition::greater_equal || continues == Condition::above_equal;
      if (continues == Condition::unknown || continues == Condition::equal) return std::nullopt;
      // Continues while gap > 0, and the gap shrinks.
      const std::int64_t gap = (less ? -difference : difference) + (equal_too ? 1 : 0);
      const std::int64_t shrinks = less ? step : -step;
      if (shrinks <= 0) return std::nullopt;
      count = gap <= 0 ? 0 : (gap + shrinks - 1) / shrinks;
      if (count < k_jumps_max && !in_range(count)) return std::nullopt;
    }
    if (count < 0 || count > k_jumps_max) return std::nullopt;
    // Sums of 32 bits are exact in a 64-bit test only while they cannot wrap around.
    const bool narrow_test = compares.left.narrow || compares.right.narrow;
    const bool narrow_sums = left.first.narrow || right.first.narrow;
    if (narrow_sums && !narrow_test && !in_range(count)) return std::nullopt;
    return count;
  }

  const FunctionGraph& graph_;
  const Loop& loop_;
  const RegisterValues& values_;
};

}  // namespace

std::optional<std::int64_t> counted_jumps_back(const FunctionGraph& graph, const Loop& loop,
                                               const RegisterValues& values) {
  return Counting(graph, loop, values).jumps_back();
}

}  // namespace glint::prove
