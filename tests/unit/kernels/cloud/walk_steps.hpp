// Reference step counts of sorting a cloud and of entering a cell, derived by hand; the tests of
// kernels that use a neighbour walk compare with them.
#pragma once

#include "kernels/cloud/neighbour_walk.hpp"

namespace glint {

// One pass computes the keys of all points; four radix passes move the points in the grid.
inline int sorting_steps(int points, int in_grid) {
  return points * k_key_steps + 4 * in_grid * k_sort_steps + 5 * k_sort_pass_steps;
}

// Comparisons for a single cell. Own row: one to find its begin, two to find its end. Four rows
// before it: 1 + 1 each. Four rows behind it: 2 + 1 each.
inline constexpr int k_single_cell_comparisons = 1 + 2 + 4 * (1 + 1) + 4 * (2 + 1);
inline constexpr int k_single_cell_steps = k_cell_steps + k_single_cell_comparisons;
// Additional steps of the searches around the worst-case cell.
inline constexpr int k_worst_cell_extra_steps = k_cell_steps_max - k_single_cell_steps;

}  // namespace glint
