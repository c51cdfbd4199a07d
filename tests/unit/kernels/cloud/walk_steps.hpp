// What sorting a cloud and entering a cell cost, counted by hand: what kernels that walk through a
// grid are compared with.
#pragma once

#include "kernels/cloud/neighbour_walk.hpp"

namespace glint {

// One pass makes the keys of all points, four more move those that the grid holds.
inline int sorting_steps(int points, int in_grid) {
  return points * k_key_steps + 4 * in_grid * k_sort_steps + 5 * k_sort_turn_steps;
}

// Where one cell stands alone: its own row is found by one comparison and ends by two, four rows
// before it take one and one, four rows behind it two and one.
inline constexpr int k_lone_cell_compared = 1 + 2 + 4 * (1 + 1) + 4 * (2 + 1);
inline constexpr int k_lone_cell_steps = k_cell_steps + k_lone_cell_compared;
// By how many steps the searches of the worst cell go beyond these.
inline constexpr int k_worst_cell_more = k_cell_steps_max - k_lone_cell_steps;

}  // namespace glint
