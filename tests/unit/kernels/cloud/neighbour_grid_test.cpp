#include "kernels/cloud/neighbour_grid.hpp"

#include <algorithm>
#include <set>

#include "clouds.hpp"

namespace glint {
namespace {

struct SortedCloud {
  explicit SortedCloud(const std::vector<Point>& of, float cell_m, int slice = 1 << 20)
      : cloud(of), memory(NeighbourGrid::bytes(static_cast<int>(of.size()))) {
    EXPECT_EQ(grid.prepare(static_cast<int>(of.size()), memory.arena()), Reason::none);
    grid.begin(cloud.points, cell_m);
    while (!grid.sorted()) grid.sort(slice);
  }
  TestCloud cloud;
  TestMemory memory;
  NeighbourGrid grid;
};

// Near the origin, and in single cells far apart: pointers must leap.
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
        EXPECT_TRUE(around.insert(sorted.grid.place_in_cloud(i)).second) << "twice";
      }
    }
    for (int i = sorted.grid.first_point(cell); i < sorted.grid.first_point(cell + 1); ++i) {
      const int place = sorted.grid.place_in_cloud(i);
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
      EXPECT_GT(sorted.grid.place_in_cloud(i), sorted.grid.place_in_cloud(i - 1));
    }
  }
}

TEST(NeighbourGrid, SortsInSlicesAsInOne) {
  const std::vector<Point> points = clusters();
  const SortedCloud whole(points, 0.05f), sliced(points, 0.05f, 13);
  ASSERT_EQ(whole.grid.count(), sliced.grid.count());
  for (int i = 0; i < whole.grid.count(); ++i) {
    ASSERT_EQ(whole.grid.place_in_cloud(i), sliced.grid.place_in_cloud(i));
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

// Cells at the end of one row and at the beginning of the next are not neighbours.
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
  EXPECT_EQ(grid.place_in_cloud(0), 1);
  EXPECT_EQ(grid.place_in_cloud(1), 0);
}

}  // namespace
}  // namespace glint
