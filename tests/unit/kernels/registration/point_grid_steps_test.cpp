// Point grid: step counts of building and searching, and the limits of a search.
#include "kernels/registration/point_grid.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <vector>

namespace glint::point_grid_steps_test {
namespace {

constexpr float k_reach = 0.125f, k_cell = k_reach / 2;

// Capacity for `capacity` points; a larger table has fewer hash collisions.
struct TestGrid {
  PointGrid grid;
  explicit TestGrid(int capacity) { EXPECT_EQ(grid.prepare(capacity), Reason::none); }
  // Returns the steps of each call.
  std::vector<int> build(const std::vector<Vector3f>& points, int budget) {
    EXPECT_EQ(grid.begin_build(points, static_cast<double>(k_reach)), Reason::none);
    std::vector<int> steps;
    for (bool done = false; !done;) {
      StepBudget left(budget);
      done = grid.build_step(left);
      steps.push_back(budget - left.left());
    }
    return steps;
  }
  int search_steps(const Vector3f& point, float radius, int expected) const {
    StepBudget budget;
    EXPECT_EQ(grid.nearest(point, radius, budget).index, expected);
    return SliceSize::k_steps_max - budget.left();
  }
};

int sum_of(const std::vector<int>& steps) {
  int sum = 0;
  for (const int step : steps) sum += step;
  return sum;
}

// Centre of a cell.
Vector3f middle_of(int x, int y, int z) {
  const auto at = [](int i) { return (static_cast<float>(i) + 0.5f) * k_cell; };
  return {at(x), at(y), at(z)};
}

TEST(PointGridSteps, OfBuildingAreThoseOfItsSlotsAndPointsInSlicesOfAnySize) {
  for (const int capacity : {1, 7, 8, 9, 1'000}) {
    TestGrid test(capacity);
    const std::vector<Vector3f> points(static_cast<std::size_t>(capacity), Vector3f(1, 1, 1));
    const int slots = static_cast<int>(std::bit_ceil(2 * static_cast<unsigned>(capacity)));
    const int expected = slots * (k_grid_clear_steps + k_grid_sum_steps) +
                         capacity * (k_grid_insert_steps + k_grid_scatter_steps);
    for (const int budget : {1, 50, SliceSize::k_steps_max}) {
      const std::vector<int> steps = test.build(points, budget);
      EXPECT_EQ(sum_of(steps), expected) << capacity << ' ' << budget;
      EXPECT_EQ(test.grid.size(), capacity);
      if (budget == 1) {
        EXPECT_EQ(steps.size(), 2u * static_cast<unsigned>(slots + capacity)) << "one at a time";
      }
      if (budget == SliceSize::k_steps_max) {
        EXPECT_EQ(steps.size(), 4u);
      }
      for (const int step : steps) EXPECT_LT(step, budget + k_grid_insert_steps_max);
    }
  }
}

TEST(PointGridSteps, OfPointsThatAreNoPlacesAreThoseOfTryingThem) {
  TestGrid test(10);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Vector3f> points(10, Vector3f(nan, 0, 0));
  EXPECT_EQ(sum_of(test.build(points, SliceSize::k_steps_max)),
            32 * (k_grid_clear_steps + k_grid_sum_steps) +
                10 * (k_grid_insert_steps + k_grid_scatter_steps));
  EXPECT_EQ(test.grid.size(), 0);
  EXPECT_EQ(test.search_steps({0, 0, 0}, k_reach, -1), 0) << "it is empty";
}

TEST(PointGridSteps, OfASearchAreThoseOfItsCells) {
  constexpr int k_cell_steps = k_grid_find_steps + k_grid_probe_steps;
  TestGrid test(1 << 15);
  (void)test.build({middle_of(40, 0, 0)}, SliceSize::k_steps_max);
  const Vector3f query = middle_of(0, 0, 0);
  EXPECT_EQ(test.search_steps(query, k_reach, -1), 125 * k_cell_steps);
  // Cells that are not neighbours are at least one cell width away.
  EXPECT_EQ(test.search_steps(query, k_cell, -1), 125 * k_cell_steps);
  EXPECT_EQ(test.search_steps(query, std::nextafter(k_cell, 0.0f), -1), 27 * k_cell_steps);
  EXPECT_EQ(test.search_steps({std::nanf(""), 0, 0}, k_reach, -1), 0);
  // A point found nearby excludes them as well.
  (void)test.build(std::vector<Vector3f>(30, query + Vector3f(0.01f, 0, 0)),
                   SliceSize::k_steps_max);
  EXPECT_EQ(test.search_steps(query, k_reach, 0), 27 * k_cell_steps + 30 * k_grid_point_steps);
  EXPECT_EQ(test.search_steps(query + Vector3f(0.01f, 0, 0), k_reach, 0),
            27 * k_cell_steps + 30 * k_grid_point_steps);
}

// One point in each non-neighbouring cell, out of reach: a search compares each once.
TEST(PointGridSteps, OfASearchLookAtEachPointOnce) {
  std::vector<Vector3f> points;
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        if (x * x < 4 && y * y < 4 && z * z < 4) continue;
        points.push_back(middle_of(x, y, z) + 0.2f * k_cell *
                                                  Vector3f(static_cast<float>(x),
                                                           static_cast<float>(y),
                                                           static_cast<float>(z)));
      }
    }
  }
  ASSERT_EQ(points.size(), 98u);
  TestGrid test(1 << 15);
  (void)test.build(points, SliceSize::k_steps_max);
  EXPECT_EQ(test.search_steps(middle_of(0, 0, 0), k_reach, -1),
            125 * (k_grid_find_steps + k_grid_probe_steps) + 98 * k_grid_point_steps);
}

TEST(PointGridSteps, EndInACrowdAfterAsManyPointsAsStated) {
  for (const int at : {k_grid_points_compared_max - 1, k_grid_points_compared_max}) {
    std::vector<Vector3f> points(k_grid_points_compared_max + 5, middle_of(0, 0, 0));
    points[static_cast<std::size_t>(at)].x() += 0.005f;
    TestGrid test(1 << 15);
    (void)test.build(points, SliceSize::k_steps_max);
    const bool looked_at = at < k_grid_points_compared_max;
    EXPECT_EQ(
        test.search_steps(middle_of(0, 0, 0) + Vector3f(0.01f, 0, 0), k_reach, looked_at ? at : 0),
        27 * (k_grid_find_steps + k_grid_probe_steps) +
            k_grid_points_compared_max * k_grid_point_steps);
  }
}

// Cells that hash to one slot, found by the extra steps of inserting them beside the first.
TEST(PointGridSteps, LookAtAsManySlotsAsDeclaredAndLeaveOutWhatHasNoneThere) {
  TestGrid test(2 * k_grid_probes_max);
  const int slots = 4 * k_grid_probes_max;
  const auto probes_of = [&](const std::vector<Vector3f>& points) {
    const int rest = slots * (k_grid_clear_steps + k_grid_sum_steps) +
                     static_cast<int>(points.size()) * (k_grid_insert_steps + k_grid_scatter_steps);
    return (sum_of(test.build(points, SliceSize::k_steps_max)) - rest) / k_grid_probe_steps;
  };
  std::vector<Vector3f> same_slot{middle_of(0, 0, 0)};
  for (int x = 1; same_slot.size() < k_grid_probes_max + 2; ++x) {
    const Vector3f candidate = middle_of(x % 1'000, x / 1'000, 0);
    if (probes_of({same_slot[0], candidate}) == 1) same_slot.push_back(candidate);
  }
  // The first needs no extra probe, each further one needs one more than the last.
  constexpr int k_fit = k_grid_probes_max * (k_grid_probes_max - 1) / 2;
  std::vector<Vector3f> all(same_slot.begin(), same_slot.begin() + k_grid_probes_max);
  EXPECT_EQ(probes_of(all), k_fit);
  EXPECT_EQ(test.grid.size(), k_grid_probes_max);
  all = same_slot;
  EXPECT_EQ(probes_of(all), k_fit + 2 * k_grid_probes_max);
  EXPECT_EQ(test.grid.size(), k_grid_probes_max);
  for (int i = 0; i < k_grid_probes_max + 2; ++i) {
    const Nearest found = test.grid.nearest(all[static_cast<std::size_t>(i)], 0.01f);
    EXPECT_EQ(found.index, i < k_grid_probes_max ? i : -1);
  }
}

TEST(PointGrid, FindsNothingAtExactlyTheRadiusAndTheFirstOfEquallyNearPoints) {
  TestGrid test(4);
  const std::vector<Vector3f> points = {{0.25f, 0, 0}, {-0.25f, 0, 0}};
  (void)test.build(points, SliceSize::k_steps_max);
  EXPECT_EQ(test.grid.nearest({0.25f + k_cell, 0, 0}, k_cell).index, -1);
  const Nearest near = test.grid.nearest({0.25f + k_cell, 0, 0}, std::nextafter(k_cell, 1.0f));
  EXPECT_EQ(near.index, 0);
  EXPECT_EQ(near.square_m2, k_cell * k_cell);
  EXPECT_EQ(test.grid.nearest({1, 0, 0}, k_cell).square_m2, k_cell * k_cell) << "none: the radius";
  // At equal distances: one point in the query's own cell, one in the next cell.
  const float off = k_cell / 4;
  for (const float side : {-1.0f, 1.0f}) {
    const Vector3f query(0, 0.3f * k_cell, 0.3f * k_cell);
    const std::vector<Vector3f> both = {query - Vector3f(side * off, 0, 0),
                                        query + Vector3f(side * off, 0, 0)};
    (void)test.build(both, SliceSize::k_steps_max);
    EXPECT_EQ(test.grid.nearest(query, k_reach).index, 0) << side;
  }
}

TEST(PointGrid, TakesEachSettingAtItsLimitAndRefusesItBeyond) {
  PointGrid grid;
  EXPECT_EQ(grid.prepare(0), Reason::out_of_range);
  EXPECT_EQ(grid.prepare(-1), Reason::out_of_range);
  EXPECT_EQ(grid.prepare(1), Reason::none);
  ASSERT_EQ(grid.prepare(3), Reason::none);
  const std::vector<Vector3f> points(4, Vector3f(0, 0, 0));
  const std::span<const Vector3f> three = std::span(points).first(3);
  const auto refused = [&](Reason reason) {
    StepBudget budget;
    EXPECT_TRUE(grid.build_step(budget)) << "there is nothing to build";
    EXPECT_EQ(budget.left(), SliceSize::k_steps_max);
    return reason;
  };
  EXPECT_EQ(refused(grid.begin_build(points, 0.1)), Reason::not_prepared);
  for (const double reach : {0.0, -0.1, 1e3, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(refused(grid.begin_build(three, reach)), Reason::out_of_range) << reach;
  }
  for (const double reach : {1e-6, 999.0}) EXPECT_EQ(grid.build(three, reach), Reason::none);
  EXPECT_EQ(grid.size(), 3);
  ASSERT_EQ(grid.prepare(3), Reason::none);
  EXPECT_EQ(grid.size(), 0) << "prepared anew it is empty";
}

TEST(PointGrid, FindsWhatAPlainSearchFindsWhereItIsBuiltInSlicesAgain) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> any(-0.6f, 0.6f);
  const auto cloud = [&](int count) {
    std::vector<Vector3f> points;
    for (int i = 0; i < count; ++i) {
      const float x = any(random), y = any(random);
      points.emplace_back(x, y, any(random));
    }
    return points;
  };
  TestGrid test(900);
  const std::vector<Vector3f> before = cloud(900), points = cloud(700);
  EXPECT_EQ(test.grid.begin_build(before, 0.3), Reason::none);
  StepBudget some(5'000);
  EXPECT_FALSE(test.grid.build_step(some));  // interrupted
  (void)test.build(points, 77);
  EXPECT_EQ(test.grid.size(), 700);
  for (const Vector3f& query : cloud(300)) {
    Nearest expected;
    expected.square_m2 = k_reach * k_reach;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const float square = (points[i] - query).squaredNorm();
      if (square < expected.square_m2) expected = {static_cast<std::int32_t>(i), square};
    }
    const Nearest found = test.grid.nearest(query, k_reach);
    EXPECT_EQ(found.index, expected.index);
    EXPECT_EQ(found.square_m2, expected.square_m2);
  }
}

}  // namespace
}  // namespace glint::point_grid_steps_test
