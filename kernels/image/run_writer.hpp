// Appends runs to a buffer, joining those that touch, until one finds it full.
//
// What:     the places where a row turns bright or dark again, two of which make a run.
// Cost:     the same for every such place; a block without one costs a shift and a comparison.
// Source:   a bit differs from its left neighbour: Warren, "Hacker's Delight", 2nd ed., section
// 2-1.
#pragma once

#include <algorithm>
#include <bit>

#include "kernels/image/run.hpp"

namespace glint {

class RunWriter {
 public:
  RunWriter(Runs& out, int limit)
      : out_(out), edges_max_(2 * std::clamp(limit, 0, static_cast<int>(out.items.size()))) {
    out.count = 0;
    out.reason = Reason::none;
  }

  // From here on pixels x0, x0 + 1, .. of row y are told; in row order, then from left to right.
  void begin_stretch(int y, int x0) {
    if (edges_ > 0) {
      const Run& last = item(edges_ - 1);
      if (last.y == y && last.x1 == x0) {  // goes on with the run before
        --edges_;
        from_ = last.x0;
      }
    }
    y_ = static_cast<std::uint16_t>(y);
  }

  // A block's pixels x + i, a bit each. False: the buffer is full, nothing more is to be told.
  template <class Mask>
  [[nodiscard]] bool add(int x, Mask mask) {
    const Mask open = edges_ & 1;
    for (Mask edges = mask ^ (mask << 1 | open); edges != 0; edges &= edges - 1) {
      if (edges_ == edges_max_) {
        out_.reason = Reason::runs_full;
        return false;
      }
      put_edge(x + std::countr_zero(edges));
    }
    return true;
  }

  // Behind the last pixel of the stretch.
  void end_stretch(int x1) {
    if ((edges_ & 1) != 0) put_edge(x1);
  }

  void finish() { out_.count = edges_ / 2; }

 private:
  [[nodiscard]] Run& item(int edge) { return out_.items[static_cast<std::size_t>(edge / 2)]; }

  // A run's first edge writes nonsense, which its second replaces: cheaper than to tell them apart.
  void put_edge(int x) {
    const auto to = static_cast<std::uint16_t>(x);
    item(edges_) = {y_, from_, to};
    from_ = to;
    ++edges_;
  }

  Runs& out_;
  int edges_max_;
  int edges_ = 0;  // odd: a run is open
  std::uint16_t y_ = 0, from_ = 0;
};

}  // namespace glint
