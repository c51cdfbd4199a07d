// Appends runs to a buffer, joining those that touch; what finds it full is counted.
#pragma once

#include <algorithm>
#include <bit>

#include "kernels/image/run.hpp"

namespace glint {

class RunWriter {
 public:
  RunWriter(Runs& out, int limit)
      : out_(out), limit_(std::clamp(limit, 0, static_cast<int>(out.items.size()))) {
    out.count = 0;
    out.dropped = 0;
    out.reason = Reason::none;
  }

  // The bright pixels x + i of row y, a bit each; in row order, then from left to right.
  void add(int y, int x, std::uint64_t mask) {
    if (mask == 0) return;
    const int end = x + 64 - std::countl_zero(mask);
    if (y == y_ && x == end_ && (mask & 1) != 0) {  // goes on with the run before
      const int ones = std::countr_one(mask);
      if (out_.dropped == 0) last().x1 = static_cast<std::uint16_t>(x + ones);
      mask = ones == 64 ? 0 : mask >> ones << ones;
    }
    y_ = y;
    end_ = end;
    while (mask != 0 && out_.count < limit_) {
      const int from = std::countr_zero(mask);
      const std::uint64_t above = mask + (mask & (~mask + 1));  // carries past the lowest run
      const int to = above == 0 ? 64 : std::countr_zero(above);
      out_.items[static_cast<std::size_t>(out_.count++)] = {static_cast<std::uint16_t>(y),
                                                            static_cast<std::uint16_t>(x + from),
                                                            static_cast<std::uint16_t>(x + to)};
      mask &= above;
    }
    if (mask != 0) {
      out_.dropped += static_cast<std::uint32_t>(std::popcount(mask & ~(mask << 1)));
      out_.reason = Reason::runs_full;
    }
  }

 private:
  Run& last() { return out_.items[static_cast<std::size_t>(out_.count - 1)]; }

  Runs& out_;
  int limit_;
  int y_ = -1, end_ = -1;  // where the newest run ended
};

}  // namespace glint
