// Goes through a grid's points cell by cell, some at a time, with the points around each cell at
// hand: what every filter that asks a point's neighbours does.
//
// Cost:  sorting (neighbour_grid.hpp), then the rows around each cell once.
// Worst: each point in a cell of its own.
#pragma once

#include <algorithm>

#include "kernels/cloud/neighbour_grid.hpp"

namespace glint {

class NeighbourWalk {
 public:
  // To be called with the grid's own begin().
  void begin() noexcept {
    sweep_.begin();
    at_ = 0;
    cell_ = -1;
  }
  // Around the cell of the point that is looked at.
  [[nodiscard]] const NeighbourSweep::Rows& rows() const noexcept { return rows_; }

  // Sorts first, at most `most` points a call, then calls enter() where a cell begins and look(i)
  // for each sorted point i, at most `most` of them. True when all were looked at.
  template <class Enter, class Look>
  [[nodiscard]] bool step(NeighbourGrid& grid, int most, Enter enter, Look look) noexcept {
    if (!grid.sorted()) {
      grid.sort(most);
      return grid.sorted() && grid.count() == 0;
    }
    const int end = std::min(grid.count(), at_ + std::max(most, 1));
    for (; at_ < end; ++at_) {
      if (at_ == grid.first_point(cell_ + 1)) {
        sweep_.rows_around(grid, ++cell_, rows_);
        enter();
      }
      look(at_);
    }
    return at_ == grid.count();
  }

 private:
  NeighbourSweep sweep_;
  NeighbourSweep::Rows rows_{};
  int at_ = 0, cell_ = -1;
};

}  // namespace glint
