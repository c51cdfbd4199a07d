#include "kernels/cloud/neighbour_grid.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "sorted_cloud.hpp"

namespace glint {
namespace {

// Dense near the origin, and isolated cells far apart, so that the sweep skips empty cells.
std::vector<Point> clusters() {
  std::vector<Point> points = random_points(1'500, 0.2f, 1);
  for (const Point& p : random_points(300, 20.0f, 2)) {
    points.push_back(p);
    points.push_back({p[0] + 0.02f, p[1], p[2] - 0.03f});
  }
  return points;
}

TEST(NeighbourSweep, FindsEveryPointWithinTheRadius) {
  const std::vector<Point> points = clusters();
  const SortedCloud sorted(points, 0.05f);
  ASSERT_EQ(sorted.grid.count(), static_cast<int>(points.size()));
  NeighbourSweep sweep;
  NeighbourSweep::Rows rows;
  sweep.begin();
  int found = 0;
  for (int cell = 0; cell < sorted.grid.cells(); ++cell) {
    sweep.rows_around(sorted.grid, cell, rows);
    std::set<int> around;
    for (const NeighbourSweep::Row& row : rows) {
      for (int i = row.begin; i < row.end; ++i) {
        EXPECT_TRUE(around.insert(sorted.grid.index_in_cloud(i)).second) << "twice";
      }
    }
    for (int i = sorted.grid.first_point(cell); i < sorted.grid.first_point(cell + 1); ++i) {
      const int place = sorted.grid.index_in_cloud(i);
      const Point point = points[static_cast<std::size_t>(place)];
      ASSERT_EQ(sorted.grid.x()[i], point[0]);
      for (std::size_t j = 0; j < points.size(); ++j) {
        if (squared_distance(point, points[j]) > 0.0499 * 0.0499) continue;
        ++found;
        ASSERT_TRUE(around.contains(static_cast<int>(j))) << place << " and " << j;
      }
    }
  }
  EXPECT_GT(found, 2 * static_cast<int>(points.size()));
}

TEST(NeighbourGrid, SortsByCellAndKeepsTheCloudsOrderWithin) {
  const SortedCloud sorted(random_points(3'000, 0.3f, 3), 0.05f);
  std::uint32_t last = 0;
  for (int cell = 0; cell < sorted.grid.cells(); ++cell) {
    EXPECT_GT(sorted.grid.key(cell), last);
    last = sorted.grid.key(cell);
    for (int i = sorted.grid.first_point(cell) + 1; i < sorted.grid.first_point(cell + 1); ++i) {
      EXPECT_GT(sorted.grid.index_in_cloud(i), sorted.grid.index_in_cloud(i - 1));
    }
  }
}

TEST(NeighbourGrid, SortsInSlicesAsInOne) {
  const std::vector<Point> points = clusters();
  const SortedCloud whole(points, 0.05f), sliced(points, 0.05f, 13);
  ASSERT_EQ(whole.grid.count(), sliced.grid.count());
  for (int i = 0; i < whole.grid.count(); ++i) {
    ASSERT_EQ(whole.grid.index_in_cloud(i), sliced.grid.index_in_cloud(i));
  }
}

TEST(NeighbourGrid, LeavesOutWhatIsBeyondItOrNotFiniteAndCountsIt) {
  const float edge = static_cast<float>(k_grid_cells_half);
  const SortedCloud sorted({{k_not_a_number, 0, 0},
                            {edge, 0, 0},
                            {0, -edge - 1, 0},
                            {edge - 0.5f, 0.5f - edge, 0},
                            {1, 2, 3}},
                           1.0f);
  EXPECT_EQ(sorted.grid.out_of_range(), 3);
  EXPECT_EQ(sorted.grid.count(), 2);
}

// The last cell of a row and the first cell of the next row are not neighbours.
TEST(NeighbourSweep, DoesNotRunFromTheEndOfARowIntoTheNext) {
  const float end = static_cast<float>(k_grid_cells_half) - 0.5f;
  const SortedCloud sorted({{end, 0.5f, 0.5f}, {-end, 1.5f, 0.5f}, {-end, 0.5f, 0.5f}}, 1.0f);
  NeighbourSweep sweep;
  NeighbourSweep::Rows rows;
  sweep.begin();
  for (int cell = 0; cell < sorted.grid.cells(); ++cell) {
    sweep.rows_around(sorted.grid, cell, rows);
    int around = 0;
    for (const NeighbourSweep::Row& row : rows) around += row.end - row.begin;
    const bool alone = sorted.grid.x()[sorted.grid.first_point(cell)] > 0;
    EXPECT_EQ(around, alone ? 1 : 2);
  }
}

TEST(NeighbourGrid, KeepsTheFirstPointsWhenFull) {
  const TestCloud cloud(std::vector<Point>{{3, 0, 0}, {2, 0, 0}, {1, 0, 0}});
  TestMemory memory(NeighbourGrid::bytes(2));
  NeighbourGrid grid;
  ASSERT_EQ(grid.prepare(2, memory.arena()), Reason::none);
  grid.begin(cloud.points, 1.0f);
  while (!grid.sorted()) grid.sort(1);
  EXPECT_EQ(grid.count(), 2);
  EXPECT_EQ(grid.dropped(), 1);
  EXPECT_EQ(grid.index_in_cloud(0), 1);
  EXPECT_EQ(grid.index_in_cloud(1), 0);
}

TEST(NeighbourGrid, EndsAtTheSameCellAlongEachAxisAndEitherWay) {
  const float edge = static_cast<float>(k_grid_cells_half);
  const float inside = std::nextafter(edge, 0.0f);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      Point on{0.5f, 0.5f, 0.5f}, within = on;
      on[axis] = side * edge;
      within[axis] = side * inside;
      const SortedCloud sorted({on, within}, 1.0f);
      EXPECT_EQ(sorted.grid.out_of_range(), 1) << axis << ' ' << side;
      ASSERT_EQ(sorted.grid.count(), 1) << axis << ' ' << side;
      EXPECT_EQ(sorted.grid.index_in_cloud(0), 1);
      // The first and the last cell of each axis stay empty.
      const std::uint32_t digit = sorted.grid.key(0) >> (axis * k_grid_axis_bits) & 1023;
      EXPECT_EQ(digit, side < 0 ? 1u : 1022u);
    }
  }
}

// A cell contains its lower boundary but not its upper one, for either sign.
TEST(NeighbourGrid, PutsAPointOnABoundaryIntoTheCellAbove) {
  const SortedCloud sorted(
      {{-1, 0, 0}, {-0.5f, 0, 0}, {0, 0, 0}, {0.5f, 0, 0}, {1, 0, 0}, {1.5f, 0, 0}}, 1.0f);
  ASSERT_EQ(sorted.grid.cells(), 3);
  for (int cell = 0; cell <= 3; ++cell) EXPECT_EQ(sorted.grid.first_point(cell), 2 * cell);
}

TEST(NeighbourGrid, CountsDownThePointsLeftInEachPass) {
  const TestCloud cloud(std::vector<Point>{{0, 0, 0}, {k_not_a_number, 0, 0}, {1, 1, 1}});
  TestMemory memory(NeighbourGrid::bytes(3));
  NeighbourGrid grid;
  ASSERT_EQ(grid.prepare(3, memory.arena()), Reason::none);
  EXPECT_TRUE(grid.sorted()) << "there is nothing to sort yet";
  EXPECT_EQ(grid.left_in_pass(), 0);
  EXPECT_EQ(grid.count(), 0);
  grid.begin(cloud.points, 1.0f);
  for (const int left : {3, 2, 1}) {
    EXPECT_FALSE(grid.keyed());
    EXPECT_EQ(grid.left_in_pass(), left);
    grid.sort(0);  // processes at least one point
  }
  for (int pass = 0; pass < 4; ++pass) {
    for (const int left : {2, 1}) {
      EXPECT_TRUE(grid.keyed() && !grid.sorted());
      EXPECT_EQ(grid.left_in_pass(), left);
      grid.sort(1);
    }
  }
  EXPECT_TRUE(grid.sorted());
  EXPECT_EQ(grid.left_in_pass(), 0);
  grid.sort(1);
  EXPECT_TRUE(grid.sorted()) << "it is sorted once";
  EXPECT_EQ(grid.count(), 2);
  TestMemory again(NeighbourGrid::bytes(3));
  ASSERT_EQ(grid.prepare(3, again.arena()), Reason::none);
  EXPECT_EQ(grid.count(), 0) << "prepared anew";
  EXPECT_EQ(grid.cells(), 0);
  EXPECT_TRUE(grid.sorted());
}

// Also if the previous sort was interrupted within a pass.
TEST(NeighbourGrid, BegunAgainSortsAsANewOne) {
  std::vector<Point> first = random_points(90, 5, 10);
  first[3][1] = k_not_a_number;
  const TestCloud large(first);
  const std::vector<Point> points = random_points(60, 5, 11);
  const SortedCloud fresh(points, 1.0f);
  for (const int slices : {5, 50, 150, 350, 1'000}) {
    TestMemory memory(NeighbourGrid::bytes(80));
    NeighbourGrid used;
    ASSERT_EQ(used.prepare(80, memory.arena()), Reason::none);
    used.begin(large.points, 0.5f);
    for (int i = 0; i < slices; ++i) used.sort(1);
    if (slices == 1'000) {
      EXPECT_EQ(used.dropped(), 9);
      EXPECT_EQ(used.out_of_range(), 1);
    }
    used.begin(fresh.cloud.points, 1.0f);
    while (!used.sorted()) used.sort(17);
    EXPECT_EQ(used.dropped() + used.out_of_range(), 0);
    ASSERT_EQ(used.count(), 60);
    ASSERT_EQ(used.cells(), fresh.grid.cells());
    for (int cell = 0; cell <= used.cells(); ++cell) {
      ASSERT_EQ(used.first_point(cell), fresh.grid.first_point(cell));
    }
    for (int i = 0; i < 60; ++i) {
      ASSERT_EQ(used.index_in_cloud(i), fresh.grid.index_in_cloud(i));
      ASSERT_EQ(used.x()[i], fresh.grid.x()[i]);
      ASSERT_EQ(used.y()[i], fresh.grid.y()[i]);
      ASSERT_EQ(used.z()[i], fresh.grid.z()[i]);
    }
  }
}

// At the limit the capacity itself is valid: the reason is missing memory.
TEST(NeighbourGrid, TakesTheMemoryThatItStatesAndRefusesLess) {
  NeighbourGrid grid;
  TestMemory one(NeighbourGrid::bytes(1));
  EXPECT_EQ(grid.prepare(0, one.arena()), Reason::out_of_range);
  EXPECT_EQ(grid.prepare(k_cloud_points_max + 1, one.arena()), Reason::out_of_range);
  EXPECT_EQ(grid.prepare(k_cloud_points_max, one.arena()), Reason::not_prepared);
  EXPECT_EQ(grid.prepare(1, one.arena()), Reason::none);
  for (int points = 1; points <= 70; ++points) {
    const std::size_t bytes = NeighbourGrid::bytes(points);
    ExactMemory enough(bytes), less(bytes - 1);
    EXPECT_EQ(grid.prepare(points, enough.arena()), Reason::none) << points;
    // Where points fill whole cache lines, bytes() counts one line too many for two of its columns.
    if (points % 16 == 0) continue;
    EXPECT_EQ(grid.prepare(points, less.arena()), Reason::not_prepared) << points;
  }
}

}  // namespace
}  // namespace glint
