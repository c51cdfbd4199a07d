#include "kernels/cloud/moving_least_squares.hpp"

#include <algorithm>
#include <map>

#include "plain_surface.hpp"

namespace glint {
namespace {

struct TestSmoothing {
  explicit TestSmoothing(int points, MovingLeastSquaresSettings settings = {})
      : memory(MovingLeastSquares::bytes(settings, points)) {
    EXPECT_EQ(smoothing.prepare(settings, points, memory.arena()), Reason::none);
  }
  std::vector<Point> run(const std::vector<Point>& points, int slice = 1 << 20,
                         int room = 1 << 16) {
    const TestCloud cloud(points);
    out = std::make_unique<TestCloud>(room);
    smoothing.begin(cloud.points);
    while (!smoothing.step(slice, out->points)) {
    }
    return out->all();
  }
  TestMemory memory;
  MovingLeastSquares smoothing;
  std::unique_ptr<TestCloud> out;
};

TEST(MovingLeastSquares, MovesEveryPointAsATextbookDoes) {
  const std::vector<Point> points = sheet_points(40, 0.01f, 0.003f, 1);
  TestSmoothing test(2'000);
  const std::vector<Point> smoothed = test.run(points);
  ASSERT_EQ(smoothed.size(), points.size());
  std::vector<Vector3> expected;
  for (const Point& p : points) {
    std::vector<Point> near;
    for (const Point& q : points) {
      if (squared_distance(p, q) <= 0.03 * 0.03) near.push_back(q);
    }
    expected.push_back(plain_surface(p, near, 0.03).point);
  }
  std::vector<bool> taken(expected.size());
  for (std::size_t i = 0; i < smoothed.size(); ++i) {
    const auto source = static_cast<std::size_t>(test.smoothing.source_of(static_cast<int>(i)));
    ASSERT_LT((expected[source] - vector_of(smoothed[i])).norm(), 3e-6);
    ASSERT_FALSE(taken[source]);
    taken[source] = true;
  }
}

TEST(MovingLeastSquares, GivesTheSameBitsInSlices) {
  const std::vector<Point> points = sheet_points(30, 0.01f, 0.003f, 2);
  TestSmoothing whole(1'000), sliced(1'000);
  EXPECT_EQ(whole.run(points), sliced.run(points, 11));
  EXPECT_EQ(whole.smoothing.reason(), Reason::none);
  for (int i = 0; i < whole.out->points.count; ++i) {
    ASSERT_EQ(whole.out->points.normal_x[i], sliced.out->points.normal_x[i]);
  }
}

TEST(MovingLeastSquares, HasUnitNormalsAcrossTheSurface) {
  TestSmoothing test(1'000);
  test.run(sheet_points(30, 0.01f, 0, 3));
  const PointCloud& out = test.out->points;
  for (int i = 0; i < out.count; ++i) {
    const Vector3 normal = vector_of({out.normal_x[i], out.normal_y[i], out.normal_z[i]});
    const double x = static_cast<double>(out.x[i]), y = static_cast<double>(out.y[i]);
    const Vector3 truth = Vector3(0.5 * y - 1.6 * x, 0.5 * x - 0.1, 1).normalized();
    ASSERT_NEAR(normal.norm(), 1, 1e-6);
    ASSERT_GT(normal.dot(truth), 1 - 1e-4);
  }
}

// Against as many points without neighbours, which take the same sorting.
TEST(MovingLeastSquares, CountsTheStepsOfEachCandidateAndNeighbour) {
  constexpr int k_crowd = 30;
  const auto steps_of = [](const std::vector<Point>& points) {
    TestSmoothing test(100);
    const TestCloud cloud(points);
    TestCloud out(100);
    int steps = 0;
    test.smoothing.begin(cloud.points);
    for (bool done = false; !done; steps += test.smoothing.steps()) {
      done = test.smoothing.step(1 << 20, out.points);
    }
    return steps;
  };
  std::vector<Point> lonely;
  for (int i = 0; i < k_crowd; ++i) lonely.push_back({static_cast<float>(i), 0, 0});
  EXPECT_GE(steps_of(std::vector<Point>(k_crowd, Point{0, 0, 0})) - steps_of(lonely),
            k_crowd * (k_near_steps * (k_crowd - 1) + k_neighbour_steps * k_crowd) -
                k_crowd * k_cell_steps_max);
}

TEST(MovingLeastSquares, LeavesOutPointsWithFewerThanThreeNeighboursAndCountsThem) {
  TestSmoothing test(100);
  EXPECT_TRUE(test.run({{0, 0, 0}}).empty());
  EXPECT_EQ(test.smoothing.lonely(), 1);
  EXPECT_TRUE(test.run({{0, 0, 0}, {0.01f, 0, 0}, {1, 0, 0}}).empty());
  EXPECT_EQ(test.smoothing.lonely(), 3);
  EXPECT_EQ(test.run({{0, 0, 0}, {0.01f, 0, 0}, {0, 0.01f, 0}}).size(), 3u);
  EXPECT_EQ(test.smoothing.flat(), 3);
}

TEST(MovingLeastSquares, GivesNothingOfNothingOrOfWhatIsNoNumberOrTooFarAway) {
  TestSmoothing test(100);
  TestCloud empty(1), out(1);
  test.smoothing.begin(empty.points);
  while (!test.smoothing.step(10, out.points)) {
  }
  EXPECT_EQ(out.points.count, 0);
  EXPECT_TRUE(test.run(std::vector<Point>(30, Point{0, k_not_a_number, 0})).empty());
  EXPECT_EQ(test.smoothing.out_of_range(), 30);
  EXPECT_TRUE(test.run(std::vector<Point>(30, Point{0, 0, 1e30f})).empty());
  EXPECT_EQ(test.smoothing.out_of_range(), 30);
}

TEST(MovingLeastSquares, LeavesCoincidentPointsWhereTheyAre) {
  TestSmoothing test(100);
  const std::vector<Point> place(30, Point{0.25f, 0.5f, -0.75f});
  EXPECT_EQ(test.run(place), place);
}

TEST(MovingLeastSquares, SaysWhenThereIsNoRoomAndWhenCandidatesWereUsedUp) {
  const std::vector<Point> points = sheet_points(20, 0.01f, 0.001f, 4);
  TestSmoothing test(400);
  const std::vector<Point> all = test.run(points);
  EXPECT_EQ(test.run(points, 50, 100), std::vector<Point>(all.begin(), all.begin() + 100));
  EXPECT_EQ(test.smoothing.dropped(), 300);
  EXPECT_EQ(test.smoothing.reason(), Reason::cloud_full);
  (void)test.run(points, 50, 399);
  EXPECT_EQ(test.smoothing.dropped(), 1);
  EXPECT_EQ(test.smoothing.reason(), Reason::cloud_full);
  MovingLeastSquaresSettings few;
  few.candidates_max = 40;
  TestSmoothing cut(400, few);
  EXPECT_EQ(cut.run(points).size(), 400u);
  EXPECT_GT(cut.smoothing.cut(), 200);
  EXPECT_EQ(cut.smoothing.reason(), Reason::search_full);
  // A crowd counts, and no point far away from it does.
  std::vector<Point> crowd(50, {0, 0, 0});
  for (int i = 1; i < 5; ++i) crowd.push_back({static_cast<float>(i), 0, 0});
  TestSmoothing far(400, few);
  far.run(crowd);
  EXPECT_EQ(far.smoothing.cut(), 50);
}

TEST(MovingLeastSquares, TakesNoMoreStepsThanItSaysForAPointAmongTheMostCandidates) {
  MovingLeastSquaresSettings few;
  few.candidates_max = 200;
  TestSmoothing test(300, few);
  const TestCloud cloud(std::vector<Point>(300, Point{0.25f, 0.5f, -0.75f}));
  TestCloud out(300);
  int most = 0;
  test.smoothing.begin(cloud.points);
  while (!test.smoothing.step(1, out.points)) most = std::max(most, test.smoothing.steps());
  EXPECT_LE(most, 1 + MovingLeastSquares::steps_max(few));
  EXPECT_GE(most, few.candidates_max * (k_near_steps + k_neighbour_steps));
}

TEST(MovingLeastSquares, RefusesAnyLessMemoryThanItAsksFor) {
  const std::size_t whole = MovingLeastSquares::bytes({}, 10);
  for (std::size_t part = 0; part < 50; ++part) {
    TestMemory memory((whole - Arena::k_alignment) * part / 50);
    MovingLeastSquares smoothing;
    EXPECT_EQ(smoothing.prepare({}, 10, memory.arena()), Reason::not_prepared) << part;
  }
}

TEST(MovingLeastSquares, RefusesWhatItCannotWorkWith) {
  TestMemory memory(MovingLeastSquares::bytes({}, 10));
  MovingLeastSquares smoothing;
  EXPECT_EQ(smoothing.prepare({0, 100, {}}, 10, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(smoothing.prepare({0.03f, 0, {}}, 10, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(smoothing.prepare({}, 0, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(smoothing.prepare({}, 10'000, memory.arena()), Reason::not_prepared);
  EXPECT_EQ(smoothing.reason(), Reason::not_prepared);
}

}  // namespace
}  // namespace glint
