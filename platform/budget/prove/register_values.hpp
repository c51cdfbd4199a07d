// Values of registers as sums of an origin and a constant, from the machine code alone.
//
// Two values of one origin at one point of a function differ by their offsets, whatever the
// origin's value is: each origin lies on every path to the point, and both values come from its
// last execution. Memory is not modelled.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "platform/budget/prove/function_graph.hpp"

namespace glint::prove {

enum class Origin : std::uint8_t {
  none,      // the offset is the value
  start,     // the register at the start of the block where the search ends
  loaded,    // the address where the program is loaded
  written,   // by an instruction of a block
  combined,  // at the start of a block, of several paths
};

struct RegisterValue {
  Origin origin = Origin::none;
  Register base = k_no_register;
  std::uint64_t place = 0;  // block, and for `written` the instruction
  std::int64_t offset = 0;
  bool narrow = false;  // only the lower 32 bits are this sum

  [[nodiscard]] bool same_origin(const RegisterValue& other) const {
    return origin == other.origin && base == other.base && place == other.place;
  }
};

class RegisterValues {
 public:
  explicit RegisterValues(const std::vector<Block>& blocks);

  // Before instruction `index` of a block, or at its end. The search ends at the start of the block
  // `start`, which dominates `block`.
  [[nodiscard]] RegisterValue before(const RegisterSum& sum, int block, std::size_t index,
                                     int start = 0) const;
  [[nodiscard]] RegisterValue at_end(Register of, int block, int start = 0) const;
  [[nodiscard]] bool dominates(int above, int below) const {
    return prove::dominates(immediate_, above, below);
  }
  [[nodiscard]] const std::vector<int>& predecessors(int block) const {
    return before_[static_cast<std::size_t>(block)];
  }

 private:
  [[nodiscard]] RegisterValue traced(const RegisterSum& sum, int block, std::size_t index,
                                     int start, int depth) const;
  [[nodiscard]] std::optional<std::int64_t> same_constant(Register of, int block, int start,
                                                          int depth) const;
  [[nodiscard]] std::uint64_t written_between(int block) const;

  const std::vector<Block>& blocks_;
  std::vector<int> immediate_;
  std::vector<std::vector<int>> before_;
  std::vector<std::uint64_t> written_;            // registers, by block
  mutable std::map<int, std::uint64_t> between_;  // after the dominator, before the block
};

}  // namespace glint::prove
