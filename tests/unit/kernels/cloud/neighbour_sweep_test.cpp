// Neighbour sweep: rows of points around a cell, and the number of comparisons of its search.
#include <cmath>
#include <set>

#include "sorted_cloud.hpp"
#include "walk_steps.hpp"

namespace glint::neighbour_sweep_test {
namespace {

// rows[0] is the cell's own row.
TEST(NeighbourSweep, RowsHoldThePointsOfThe27CellsAroundAndNoOthers) {
  const SortedCloud sorted(random_points(700, 4.5f, 7), 1.0f);
  const auto cell_of = [](const NeighbourGrid& grid, int i) {
    return std::array{std::floor(grid.x()[i]), std::floor(grid.y()[i]), std::floor(grid.z()[i])};
  };
  NeighbourSweep sweep;
  NeighbourSweep::Rows rows;
  sweep.begin();
  for (int cell = 0; cell < sorted.grid.cells(); ++cell) {
    sweep.rows_around(sorted.grid, cell, rows);
    const auto own = cell_of(sorted.grid, sorted.grid.first_point(cell));
    std::set<int> expected, own_row, found;
    for (int i = 0; i < sorted.grid.count(); ++i) {
      const auto other = cell_of(sorted.grid, i);
      const float dx = other[0] - own[0], dy = other[1] - own[1], dz = other[2] - own[2];
      if (dx * dx > 1 || dy * dy > 1 || dz * dz > 1) continue;
      expected.insert(i);
      if (dy == 0 && dz == 0) own_row.insert(i);
    }
    for (const NeighbourSweep::Row& row : rows) {
      for (int i = row.begin; i < row.end; ++i) found.insert(i);
    }
    ASSERT_EQ(found, expected) << cell;
    ASSERT_EQ(rows[0].begin, *own_row.begin());
    ASSERT_EQ(rows[0].end - rows[0].begin, static_cast<int>(own_row.size()));
  }
}

// Eight linear comparisons, then binary search: 63 cells take six bisections for any key.
TEST(NeighbourSweep, ComparesOneByOneThenByHalves) {
  NeighbourSweep sweep;
  NeighbourSweep::Rows rows;
  const SortedCloud lone({{0.5f, 0.5f, 0.5f}}, 1.0f);
  sweep.begin();
  EXPECT_EQ(sweep.rows_around(lone.grid, 0, rows), k_single_cell_comparisons);
  std::vector<Point> line;
  for (int x = 0; x < 69; ++x) line.push_back({static_cast<float>(x) + 0.5f, 0.5f, 0.5f});
  line.push_back({0.5f, 0.5f, 1.5f});
  line.push_back({68.5f, 0.5f, 1.5f});
  const SortedCloud sorted(line, 1.0f);
  ASSERT_EQ(sorted.grid.cells(), 71);
  sweep.begin();
  // Own row: 1 + 3. Each of the four rows before it: 1 + 1. Each of the four rows behind the line:
  // 8 + 6 to find its begin. The row above has one near cell, the other three have none.
  EXPECT_EQ(sweep.rows_around(sorted.grid, 0, rows), 4 + 4 * 2 + 4 * (8 + 6) + 3 * 1 + 2);
  // The next cell's rows begin where the last one's did; only its own row advances, by one cell.
  EXPECT_EQ(sweep.rows_around(sorted.grid, 1, rows), 3 + 8 * 2);
}

TEST(NeighbourSweep, BegunAgainFindsTheRowsOfAnotherGrid) {
  const SortedCloud first(random_points(300, 3, 8), 1.0f), second(random_points(300, 3, 9), 1.0f);
  NeighbourSweep used, fresh;
  NeighbourSweep::Rows a, b;
  used.begin();
  for (int cell = 0; cell < first.grid.cells(); ++cell) used.rows_around(first.grid, cell, a);
  used.begin();
  fresh.begin();
  for (int cell = 0; cell < second.grid.cells(); ++cell) {
    ASSERT_EQ(used.rows_around(second.grid, cell, a), fresh.rows_around(second.grid, cell, b));
    for (std::size_t row = 0; row < a.size(); ++row) {
      ASSERT_EQ(a[row].begin, b[row].begin);
      ASSERT_EQ(a[row].end, b[row].end);
    }
  }
}

}  // namespace
}  // namespace glint::neighbour_sweep_test
