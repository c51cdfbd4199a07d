// Run-length encoder: writes runs from bit masks into a buffer, joins adjacent ones, stops if full.
//
// What:     the edges at which a row changes between dark and bright; two edges make a run.
// Cost:     the same for every edge; a block without an edge costs a shift and a comparison.
// Source:   a bit differs from its left neighbour: Warren, "Hacker's Delight", 2nd ed.,
//           section 2-1.
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

  // Starts a row segment at pixel x0 of row y. Requires segments in row-major order.
  void begin_segment(int y, int x0) {
    if (edges_ > 0) {
      const Run& last = item(edges_ - 1);
      if (last.y == y && last.x1 == x0) {  // continues the previous run
        --edges_;
        from_ = last.x0;
      }
    }
    y_ = static_cast<std::uint16_t>(y);
  }

  // Adds a block: bit i of the mask is pixel x + i. Returns false if the buffer is full; then add
  // nothing more.
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

  // x1: one past the last pixel of the segment.
  void end_segment(int x1) {
    if ((edges_ & 1) != 0) put_edge(x1);
  }

  void finish() { out_.count = edges_ / 2; }

 private:
  [[nodiscard]] Run& item(int edge) { return out_.items[static_cast<std::size_t>(edge / 2)]; }

  // The first edge of a run writes an invalid run, which the second replaces: no branch is needed.
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
