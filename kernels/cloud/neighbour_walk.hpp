// Iterates over the points of a neighbour grid cell by cell, in slices, with the point ranges
// around each cell. Shared by all filters that use neighbours.
//
// Cost:  sorting (neighbour_grid.hpp), then once per cell the rows around it.
// Worst: each point in its own cell.
#pragma once

#include <algorithm>

#include "kernels/cloud/neighbour_grid.hpp"
#include "kernels/slice_size.hpp"

namespace glint {

inline constexpr int k_key_steps = 20, k_sort_steps = 6;  // per point, once; per point, four times
// At the start of sorting and between two passes: clearing and summing of the digits.
inline constexpr int k_sort_pass_steps = 4096;
// Per cell, without the search for the rows around it.
inline constexpr int k_cell_steps = 100;
inline constexpr int k_cell_steps_max = k_cell_steps + 2 * k_cell_rows * k_row_search_max;

class NeighbourWalk {
 public:
  // Call together with the grid's begin().
  void begin() noexcept {
    sweep_.begin();
    at_ = 0;
    cell_ = -1;
    taken_ = 0;
  }
  // Rows around the cell of the current point.
  [[nodiscard]] const NeighbourSweep::Rows& rows() const noexcept { return rows_; }

  // Steps of the last call of step().
  [[nodiscard]] int steps() const noexcept { return taken_; }

  // Sorts first. Then calls enter() at the start of each cell and look(i) for each sorted point i,
  // at most `most` points a call; both return the steps they took. Returns true when all points are
  // processed.
  template <class Enter, class Look>
  [[nodiscard]] bool step(NeighbourGrid& grid, SliceSize most, Enter enter, Look look) noexcept {
    if (!grid.sorted()) {
      const int left = grid.left_in_pass(), each = grid.keyed() ? k_sort_steps : k_key_steps;
      const int points = std::min(most.items_of(each), left);
      taken_ = each * points + (points == left ? k_sort_pass_steps : 0);
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
