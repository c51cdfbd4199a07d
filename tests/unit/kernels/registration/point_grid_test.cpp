#include "kernels/registration/point_grid.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace glint::point_grid_test {
namespace {

std::vector<Vector3f> cloud(int count, float side) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> any(-side, side);
  std::vector<Vector3f> points;
  for (int i = 0; i < count; ++i) {
    const float x = any(random), y = any(random), z = any(random);
    points.emplace_back(x, y, z);
  }
  return points;
}

Nearest nearest_by_brute_force(const std::vector<Vector3f>& points, const Vector3f& p,
                               float radius) {
  Nearest best;
  best.square_m2 = radius * radius;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float square = (points[i] - p).squaredNorm();
    if (square < best.square_m2) best = {static_cast<std::int32_t>(i), square};
  }
  return best;
}

TEST(PointGrid, FindsWhatAPlainSearchFinds) {
  const std::vector<Vector3f> points = cloud(3000, 0.5f);
  PointGrid grid;
  ASSERT_EQ(grid.prepare(3000), Reason::none);
  for (const float reach : {0.02f, 0.06f, 0.15f}) {
    ASSERT_EQ(grid.build(points, static_cast<double>(reach)), Reason::none);
    int found = 0;
    for (const Vector3f& p : cloud(500, 0.6f)) {
      const Vector3f q = p + Vector3f(0.003f, -0.01f, 0.007f);
      const Nearest nearest = grid.nearest(q, reach),
                    expected = nearest_by_brute_force(points, q, reach);
      EXPECT_EQ(nearest.index, expected.index);
      EXPECT_EQ(nearest.square_m2, expected.square_m2);
      found += nearest.index >= 0 ? 1 : 0;
    }
    EXPECT_GT(found, 5);
  }
}

TEST(PointGrid, LeavesOutWhatIsNoPlace) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<Vector3f> points = {{nan, 0, 0}, {0, infinity, 0}, {1e30f, 0, 0}, {1, 0, 0}};
  PointGrid grid;
  ASSERT_EQ(grid.prepare(4), Reason::none);
  ASSERT_EQ(grid.build(points, 0.1), Reason::none);
  EXPECT_EQ(grid.size(), 1);
  EXPECT_EQ(grid.nearest({1, 0.05f, 0}, 0.1f).index, 3);
  EXPECT_EQ(grid.nearest({nan, 0, 0}, 0.1f).index, -1);
  // Points 10 km away are beyond the grid, on each axis and either side.
  for (const float end : {-1e4f, 1e4f}) {
    const std::vector<Vector3f> far = {{end, 0, 0}, {0, end, 0}, {0, 0, end}, {1, 0, 0}};
    ASSERT_EQ(grid.build(far, 0.1), Reason::none);
    EXPECT_EQ(grid.size(), 1);
  }
}

TEST(PointGrid, HoldsNothingWhereNothingWasGiven) {
  PointGrid grid;
  EXPECT_EQ(grid.nearest({0, 0, 0}, 1).index, -1);
  EXPECT_EQ(grid.prepare(0), Reason::out_of_range);
  ASSERT_EQ(grid.prepare(2), Reason::none);
  EXPECT_EQ(grid.build({}, 0.1), Reason::none);
  EXPECT_EQ(grid.nearest({0, 0, 0}, 0.1f).index, -1);
  EXPECT_EQ(grid.build(cloud(3, 1), 0.1), Reason::not_prepared);
  EXPECT_EQ(grid.build(cloud(2, 1), 0), Reason::out_of_range);
}

TEST(PointGrid, TakesTheFirstOfPointsInOnePlaceAndEndsInACrowd) {
  const std::vector<Vector3f> points(20'000, Vector3f(1, 1, 1));
  PointGrid grid;
  ASSERT_EQ(grid.prepare(20'000), Reason::none);
  ASSERT_EQ(grid.build(points, 0.1), Reason::none);
  EXPECT_EQ(grid.nearest({1, 1, 1.01f}, 0.1f).index, 0);
}

// Steps of its cells, and of each point compared.
TEST(PointGrid, TakesItsStepsFromTheBudget) {
  const auto steps_for = [](int points) {
    PointGrid grid;
    EXPECT_EQ(grid.prepare(100), Reason::none);
    EXPECT_EQ(grid.build(std::vector<Vector3f>(static_cast<std::size_t>(points), {1, 1, 1}), 0.1),
              Reason::none);
    StepBudget budget(1'000'000);
    EXPECT_EQ(grid.nearest({1, 1, 1.01f}, 0.1f, budget).index, 0);
    return 1'000'000 - budget.left();
  };
  EXPECT_EQ(steps_for(90) - steps_for(10), 80 * k_grid_point_steps);
  EXPECT_GE(steps_for(10), k_grid_find_steps + 10 * k_grid_point_steps);
}

}  // namespace
}  // namespace glint::point_grid_test
