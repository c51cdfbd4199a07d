// Neighbour walk: visiting order and step count over the points of a grid.
#include "kernels/cloud/neighbour_walk.hpp"

#include "clouds.hpp"
#include "walk_steps.hpp"

namespace glint::neighbour_walk_test {
namespace {

constexpr SliceSize k_whole = 1 << 20;

struct TestWalk {
  explicit TestWalk(const std::vector<Point>& points)
      : cloud(points), memory(NeighbourGrid::bytes(k_capacity)) {
    EXPECT_EQ(grid.prepare(k_capacity, memory.arena()), Reason::none);
    begin(cloud.points);
  }
  void begin(const PointCloud& points) {
    grid.begin(points, 1.0f);
    walk.begin();
    calls = steps = 0;
    entered.clear();
    seen.clear();
  }
  // One call; entering a cell costs enter_steps, visiting a point look_steps.
  bool step(SliceSize most, int enter_steps = 0, int look_steps = 0) {
    const bool done = walk.step(
        grid, most,
        [&] {
          entered.push_back(static_cast<int>(seen.size()));
          own_rows.push_back(walk.rows()[0]);
          return enter_steps;
        },
        [&](int point) {
          seen.push_back(point);
          return look_steps;
        });
    ++calls;
    steps += walk.steps();
    return done;
  }
  void sort(SliceSize most) {
    while (!grid.sorted()) EXPECT_FALSE(step(most) && grid.count() > 0);
  }
  static constexpr int k_capacity = 80;
  TestCloud cloud;
  TestMemory memory;
  NeighbourGrid grid;
  NeighbourWalk walk;
  int calls = 0, steps = 0;
  std::vector<int> entered, seen;
  std::vector<NeighbourSweep::Row> own_rows;
};

// counts[i] points in the cell (i, 0, 0).
std::vector<Point> points_in_cells(const std::vector<int>& counts) {
  std::vector<Point> points;
  for (std::size_t cell = 0; cell < counts.size(); ++cell) {
    for (int i = 0; i < counts[cell]; ++i) {
      points.push_back({static_cast<float>(cell) + 0.5f, 0.5f, 0.01f * static_cast<float>(i)});
    }
  }
  return points;
}

TEST(NeighbourWalk, SortsInFivePassesForTheSameStepsInSlicesOfAnySize) {
  std::vector<Point> points = points_in_cells({20, 30});
  for (int i = 0; i < 3; ++i) points.push_back({k_not_a_number, 0, 0});
  const struct {
    SliceSize most;
    int calls;
  } cases[] = {{k_whole, 5},
               {7, 8 + 4 * 8},
               {1, 53 + 4 * 50},
               {{1 << 20, 3 * k_key_steps}, 18 + 4 * 5},  // ten points a call in the later passes
               {{1 << 20, 1}, 53 + 4 * 50}};
  for (const auto& [most, calls] : cases) {
    TestWalk test(points);
    test.sort(most);
    EXPECT_EQ(test.calls, calls);
    EXPECT_EQ(test.steps, sorting_steps(53, 50)) << calls << " calls";
    EXPECT_TRUE(test.seen.empty());
  }
}

TEST(NeighbourWalk, EndsWithTheSortingWhereTheGridHoldsNothing) {
  TestWalk nothing(std::vector<Point>{}), no_places(std::vector<Point>(9, {0, k_not_a_number, 0}));
  for (TestWalk* test : {&nothing, &no_places}) {
    for (int pass = 1; pass <= 5; ++pass) EXPECT_EQ(test->step(k_whole), pass == 5);
    EXPECT_EQ(test->steps, sorting_steps(test->cloud.points.count, 0));
    EXPECT_TRUE(test->entered.empty());
  }
}

TEST(NeighbourWalk, EntersEachCellOnceBeforeItsPointsInTheirOrder) {
  for (const int slice : {1, 2, 3, 100}) {
    TestWalk test(points_in_cells({4, 1, 3}));
    test.sort(k_whole);
    test.calls = 0;
    while (!test.step(slice)) {
    }
    EXPECT_EQ(test.seen, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
    EXPECT_EQ(test.entered, (std::vector<int>{0, 4, 5}));
    EXPECT_EQ(test.calls, (8 + slice - 1) / slice);
    // rows[0]: the cell itself and its neighbours along x.
    ASSERT_EQ(test.own_rows.size(), 3u);
    const int begin[] = {0, 0, 4}, end[] = {5, 8, 8};
    for (std::size_t cell = 0; cell < 3; ++cell) {
      EXPECT_EQ(test.own_rows[cell].begin, begin[cell]);
      EXPECT_EQ(test.own_rows[cell].end, end[cell]);
    }
  }
}

TEST(NeighbourWalk, AddsUpTheStepsOfCellsOfEntriesAndOfPoints) {
  constexpr int k_enter = 1'000, k_look = 10;
  TestWalk test(points_in_cells({4, 1, 3}));
  test.sort(k_whole);
  int compared = 0;
  NeighbourSweep sweep;
  NeighbourSweep::Rows rows;
  sweep.begin();
  for (int cell = 0; cell < 3; ++cell) compared += sweep.rows_around(test.grid, cell, rows);
  test.steps = 0;
  EXPECT_TRUE(test.step(k_whole, k_enter, k_look));
  EXPECT_EQ(test.steps, 3 * (k_cell_steps + k_enter) + compared + 8 * k_look);
  EXPECT_TRUE(test.step(k_whole, k_enter, k_look)) << "all were looked at";
  EXPECT_EQ(test.walk.steps(), 0);
}

TEST(NeighbourWalk, BeginsNoPointOnceTheStepsAreUsedUp) {
  constexpr int k_look = 10;
  TestWalk test(points_in_cells({8}));
  test.sort(k_whole);
  EXPECT_FALSE(test.step({1 << 20, k_single_cell_steps + k_look}, 0, k_look));
  EXPECT_EQ(test.seen.size(), 1u);
  EXPECT_EQ(test.walk.steps(), k_single_cell_steps + k_look);
  EXPECT_FALSE(test.step({1 << 20, 2 * k_look}, 0, k_look));
  EXPECT_EQ(test.seen.size(), 3u);
  EXPECT_FALSE(test.step({1 << 20, 2 * k_look + 1}, 0, k_look));
  EXPECT_EQ(test.seen.size(), 6u) << "the last one goes beyond";
  EXPECT_EQ(test.walk.steps(), 3 * k_look);
  EXPECT_TRUE(test.step({1 << 20, 2 * k_look}, 0, k_look));
  EXPECT_EQ(test.seen.size(), 8u);
}

TEST(NeighbourWalk, BegunAgainGoesAsANewOne) {
  const std::vector<Point> second = points_in_cells({2, 5, 1});
  TestWalk fresh(second), used(points_in_cells({9, 9, 9, 9}));
  used.sort(k_whole);
  EXPECT_FALSE(used.step(20));  // interrupted before its last point
  const TestCloud cloud(second);
  used.begin(cloud.points);
  EXPECT_EQ(used.walk.steps(), 0);
  for (TestWalk* test : {&fresh, &used}) {
    test->sort(3);
    while (!test->step(2, 7, 3)) {
    }
  }
  EXPECT_EQ(used.seen, fresh.seen);
  EXPECT_EQ(used.entered, fresh.entered);
  EXPECT_EQ(used.steps, fresh.steps);
  EXPECT_EQ(used.calls, fresh.calls);
}

}  // namespace
}  // namespace glint::neighbour_walk_test
