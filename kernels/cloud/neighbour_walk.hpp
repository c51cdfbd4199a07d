// Goes through a grid's points cell by cell, some at a time, with the points around each cell at
// hand: what every filter that asks a point's neighbours does.
//
// Cost:  sorting (neighbour_grid.hpp), then the rows around each cell once.
// Worst: each point in a cell of its own.
#pragma once

#include <algorithm>

#include "kernels/cloud/neighbour_grid.hpp"
#include "kernels/slice_size.hpp"

namespace glint {

inline constexpr int k_key_steps = 20, k_sort_steps = 6;  // of a point, once; four times after
// Of the sorting itself, at its beginning and between two passes: the digits are cleared and
// summed.
inline constexpr int k_sort_turn_steps = 4096;
// Of a cell, beside those of finding the rows around it.
inline constexpr int k_cell_steps = 100;
inline constexpr int k_cell_steps_max = k_cell_steps + 2 * k_cell_rows * k_row_search_max;

class NeighbourWalk {
 public:
  // To be called with the grid's own begin().
  void begin() noexcept {
    sweep_.begin();
    at_ = 0;
    cell_ = -1;
    taken_ = 0;
  }
  // Around the cell of the point that is looked at.
  [[nodiscard]] const NeighbourSweep::Rows& rows() const noexcept { return rows_; }

  // Of the last call of step().
  [[nodiscard]] int steps() const noexcept { return taken_; }

  // Sorts first, then calls enter() where a cell begins and look(i) for each sorted point i, at
  // most `most` points a call; both say how many steps they took. True when all were looked at.
  template <class Enter, class Look>
  [[nodiscard]] bool step(NeighbourGrid& grid, SliceSize most, Enter enter, Look look) noexcept {
    if (!grid.sorted()) {
      const int left = grid.left_in_pass(), each = grid.keyed() ? k_sort_steps : k_key_steps;
      const int points = std::min(most.items_of(each), left);
      taken_ = each * points + (points == left ? k_sort_turn_steps : 0);
      grid.sort(points);
      return grid.sorted() && grid.count() == 0;
    }
    taken_ = 0;
    const int end = grid.count() - at_ < most.items ? grid.count() : at_ + most.items;
    for (; at_ < end && taken_ < most.steps; ++at_) {
      if (at_ == grid.first_point(cell_ + 1)) {
        taken_ += k_cell_steps + sweep_.rows_around(grid, ++cell_, rows_);
        taken_ += enter();
      }
      taken_ += look(at_);
    }
    return at_ == grid.count();
  }

 private:
  NeighbourSweep sweep_;
  NeighbourSweep::Rows rows_{};
  int at_ = 0, cell_ = -1, taken_ = 0;
};

}  // namespace glint
