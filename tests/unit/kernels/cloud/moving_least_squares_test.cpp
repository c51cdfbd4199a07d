#include "kernels/cloud/moving_least_squares.hpp"

#include <algorithm>
#include <map>

#include "reference_surface.hpp"
#include "walk_steps.hpp"

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
  const std::vector<Point> points = curved_surface_points(40, 0.01f, 0.003f, 1);
  TestSmoothing test(2'000);
  const std::vector<Point> smoothed = test.run(points);
  ASSERT_EQ(smoothed.size(), points.size());
  std::vector<Vector3> expected;
  for (const Point& p : points) {
    std::vector<Point> near;
    for (const Point& q : points) {
      if (squared_distance(p, q) <= 0.03 * 0.03) near.push_back(q);
    }
    expected.push_back(reference_surface(p, near, 0.03).point);
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
  const std::vector<Point> points = curved_surface_points(30, 0.01f, 0.003f, 2);
  TestSmoothing whole(1'000), sliced(1'000);
  EXPECT_EQ(whole.run(points), sliced.run(points, 11));
  EXPECT_EQ(whole.smoothing.reason(), Reason::none);
  for (int i = 0; i < whole.out->points.count; ++i) {
    ASSERT_EQ(whole.out->points.normal_x[i], sliced.out->points.normal_x[i]);
  }
}

TEST(MovingLeastSquares, HasUnitNormalsAcrossTheSurface) {
  TestSmoothing test(1'000);
  test.run(curved_surface_points(30, 0.01f, 0, 3));
  const PointCloud& out = test.out->points;
  for (int i = 0; i < out.count; ++i) {
    const Vector3 normal = vector_of({out.normal_x[i], out.normal_y[i], out.normal_z[i]});
    const double x = static_cast<double>(out.x[i]), y = static_cast<double>(out.y[i]);
    const Vector3 truth = Vector3(0.5 * y - 1.6 * x, 0.5 * x - 0.1, 1).normalized();
    ASSERT_NEAR(normal.norm(), 1, 1e-6);
    ASSERT_GT(normal.dot(truth), 1 - 1e-4);
  }
}

// The difference to as many points without neighbours; sorting costs the same.
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
  std::vector<Point> isolated;
  for (int i = 0; i < k_crowd; ++i) isolated.push_back({static_cast<float>(i), 0, 0});
  EXPECT_GE(steps_of(std::vector<Point>(k_crowd, Point{0, 0, 0})) - steps_of(isolated),
            k_crowd * (k_near_steps * (k_crowd - 1) + k_neighbour_steps * k_crowd) -
                k_crowd * k_cell_steps_max);
}

TEST(MovingLeastSquares, LeavesOutPointsWithFewerThanThreeNeighboursAndCountsThem) {
  TestSmoothing test(100);
  EXPECT_TRUE(test.run({{0, 0, 0}}).empty());
  EXPECT_EQ(test.smoothing.isolated(), 1);
  EXPECT_TRUE(test.run({{0, 0, 0}, {0.01f, 0, 0}, {1, 0, 0}}).empty());
  EXPECT_EQ(test.smoothing.isolated(), 3);
  EXPECT_EQ(test.run({{0, 0, 0}, {0.01f, 0, 0}, {0, 0.01f, 0}}).size(), 3u);
  EXPECT_EQ(test.smoothing.on_plane(), 3);
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
  const std::vector<Point> points = curved_surface_points(20, 0.01f, 0.001f, 4);
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
  EXPECT_GT(cut.smoothing.candidates_exceeded(), 200);
  EXPECT_EQ(cut.smoothing.reason(), Reason::search_full);
  // Points of a crowd reach the limit; points far away from it do not.
  std::vector<Point> crowd(50, {0, 0, 0});
  for (int i = 1; i < 5; ++i) crowd.push_back({static_cast<float>(i), 0, 0});
  TestSmoothing far(400, few);
  far.run(crowd);
  EXPECT_EQ(far.smoothing.candidates_exceeded(), 50);
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

// All points are at one position, so that each is a neighbour of each.
TEST(MovingLeastSquares, CountsTheStepsOfACrowdByHand) {
  const struct {
    int crowd, candidates, room;
  } cases[] = {{1, 4096, 50}, {2, 4096, 50}, {3, 4096, 50}, {40, 4096, 50}, {40, 40, 50},
               {40, 39, 50},  {40, 2, 50},   {40, 1, 50},   {40, 4096, 7}};
  for (const auto& [crowd, candidates, room] : cases) {
    MovingLeastSquaresSettings settings;
    settings.candidates_max = candidates;
    TestSmoothing test(50, settings);
    const TestCloud cloud(std::vector<Point>(static_cast<std::size_t>(crowd), {0.01f, 0, 0}));
    const int near = std::min(crowd, candidates);
    const bool isolated = near < k_plane_neighbours_min;
    const int of_point =
        k_surface_steps + near * k_near_steps + (isolated ? 0 : near * k_neighbour_steps);
    for (const int slice : {1 << 20, 3}) {
      TestCloud out(room);
      test.smoothing.begin(cloud.points);
      int steps = 0;
      for (bool done = false; !done; steps += test.smoothing.steps()) {
        done = test.smoothing.step(slice, out.points);
      }
      EXPECT_EQ(steps, sorting_steps(crowd, crowd) + k_single_cell_steps + near * k_gather_steps +
                           crowd * of_point)
          << crowd << " of " << candidates;
      EXPECT_EQ(out.points.count, isolated ? 0 : std::min(crowd, room));
      EXPECT_EQ(test.smoothing.isolated(), isolated ? crowd : 0);
      EXPECT_EQ(test.smoothing.on_plane(), isolated ? 0 : crowd);
      EXPECT_EQ(test.smoothing.candidates_exceeded(), crowd > candidates ? crowd : 0);
      EXPECT_EQ(test.smoothing.dropped(), isolated ? 0 : std::max(crowd - room, 0));
    }
  }
}

TEST(MovingLeastSquares, StatesTheStepsOfThePointWithTheMostCandidates) {
  MovingLeastSquaresSettings few;
  few.candidates_max = 200;
  TestSmoothing test(300, few);
  const TestCloud cloud(std::vector<Point>(300, Point{0.25f, 0.5f, -0.75f}));
  TestCloud out(300);
  test.smoothing.begin(cloud.points);
  while (!test.smoothing.step(1, out.points) && out.points.count == 0) {
  }
  EXPECT_EQ(MovingLeastSquares::steps_max(few) - test.smoothing.steps(), k_worst_cell_extra_steps);
}

TEST(MovingLeastSquares, CountsANeighbourAtExactlyTheRadius) {
  MovingLeastSquaresSettings settings;
  settings.radius_m = 0.03125f;
  TestSmoothing test(10, settings);
  // The corner point has two neighbours, the other two points one each.
  EXPECT_EQ(test.run({{0, 0, 0}, {0.03125f, 0, 0}, {0, 0.03125f, 0}}).size(), 1u);
  EXPECT_EQ(test.smoothing.isolated(), 2);
  EXPECT_EQ(test.smoothing.source_of(0), 0);
}

TEST(MovingLeastSquares, TakesWeightsAsItsSettingSaysAndKeepsThemAnyway) {
  const std::vector<Point> points = curved_surface_points(12, 0.01f, 0.003f, 6);
  const auto smoothed = [&](NeighbourWeights weights, bool uneven) {
    MovingLeastSquaresSettings settings;
    settings.weights = weights;
    TestSmoothing test(200, settings);
    TestCloud cloud(points), out(200);
    for (int i = 0; i < cloud.points.count; ++i) {
      cloud.points.weight[i] = uneven ? static_cast<float>(1 + i % 5) : 1.0f;
    }
    test.smoothing.begin(cloud.points);
    while (!test.smoothing.step(20, out.points)) {
    }
    for (int i = 0; i < out.points.count; ++i) {
      EXPECT_EQ(out.points.weight[i], cloud.points.weight[test.smoothing.source_of(i)]) << i;
    }
    return out.all();
  };
  const auto even = smoothed(NeighbourWeights::by_measurements, false);
  EXPECT_EQ(smoothed(NeighbourWeights::equal, true), even);
  EXPECT_EQ(smoothed(NeighbourWeights::equal, false), even);
  EXPECT_NE(smoothed(NeighbourWeights::by_measurements, true), even);
}

TEST(MovingLeastSquares, BegunAgainSmoothsAsANewOneAndCountsAnew) {
  const std::vector<Point> points = curved_surface_points(12, 0.01f, 0.003f, 7);
  std::vector<Point> wrong(60, Point{0, 0, 0});
  wrong[0][2] = k_not_a_number;
  for (int i = 1; i < 100; ++i) wrong.push_back({0.1f * static_cast<float>(i), 0, 0});
  MovingLeastSquaresSettings few;
  few.candidates_max = 50;
  TestSmoothing used(144, few), fresh(144, few);
  (void)used.run(wrong, 9, 10);
  EXPECT_EQ(used.smoothing.out_of_range(), 1);
  EXPECT_EQ(used.smoothing.dropped(), 14 + 49) << "of the grid and of the cloud";
  EXPECT_EQ(used.smoothing.candidates_exceeded(), 59);
  EXPECT_EQ(used.smoothing.on_plane(), 59);
  EXPECT_EQ(used.smoothing.isolated(), 85);
  EXPECT_EQ(used.smoothing.reason(), Reason::cloud_full) << "which counts before a search cut";
  EXPECT_EQ(used.run(points), fresh.run(points));
  EXPECT_EQ(used.smoothing.out_of_range(), 0);
  EXPECT_EQ(used.smoothing.dropped(), 0);
  EXPECT_EQ(used.smoothing.candidates_exceeded(), fresh.smoothing.candidates_exceeded());
  EXPECT_EQ(used.smoothing.on_plane(), fresh.smoothing.on_plane());
  EXPECT_EQ(used.smoothing.isolated(), fresh.smoothing.isolated());
  for (int i = 0; i < 144; ++i) {
    ASSERT_EQ(used.smoothing.source_of(i), fresh.smoothing.source_of(i));
  }
}

TEST(MovingLeastSquares, TakesEachSettingAtItsLimitAndRefusesItBeyond) {
  const auto reason_of = [](float radius_m, int candidates, int points = 10) {
    TestMemory memory(MovingLeastSquares::bytes({0.03f, 100, {}}, 10));
    MovingLeastSquares smoothing;
    const Reason reason = smoothing.prepare({radius_m, candidates, {}}, points, memory.arena());
    EXPECT_EQ(smoothing.reason(), reason == Reason::none ? reason : Reason::not_prepared);
    if (reason != Reason::none) {
      TestCloud cloud(1);
      smoothing.begin(cloud.points);
      EXPECT_TRUE(smoothing.step(1, cloud.points));
    }
    return reason;
  };
  EXPECT_EQ(reason_of(1e-38f, 100), Reason::none);
  EXPECT_EQ(reason_of(0.03f, 1), Reason::none);
  EXPECT_EQ(reason_of(0.03f, k_cloud_points_max), Reason::not_prepared);
  EXPECT_EQ(reason_of(0.03f, k_cloud_points_max + 1), Reason::out_of_range);
  EXPECT_EQ(reason_of(0.03f, 0), Reason::out_of_range);
  EXPECT_EQ(reason_of(0, 100), Reason::out_of_range);
  EXPECT_EQ(reason_of(-1, 100), Reason::out_of_range);
  EXPECT_EQ(reason_of(1e-40f, 100), Reason::out_of_range);
  EXPECT_EQ(reason_of(k_not_a_number, 100), Reason::out_of_range);
  EXPECT_EQ(reason_of(0.03f, 100, 0), Reason::out_of_range);
  EXPECT_EQ(reason_of(0.03f, 100, k_cloud_points_max), Reason::not_prepared);
  ExactMemory enough(MovingLeastSquares::bytes({}, 10));
  EXPECT_EQ(MovingLeastSquares().prepare({}, 10, enough.arena()), Reason::none);
  ExactMemory less(MovingLeastSquares::bytes({}, 10) - 1);
  EXPECT_EQ(MovingLeastSquares().prepare({}, 10, less.arena()), Reason::not_prepared);
}

TEST(MovingLeastSquares, IsPreparedNoLongerOnceASettingIsRefused) {
  TestSmoothing test(20);
  EXPECT_EQ(test.run(std::vector<Point>(12, Point{0, 0, 0})).size(), 12u);
  TestMemory memory(MovingLeastSquares::bytes({}, 20));
  EXPECT_EQ(test.smoothing.prepare({0.03f, 0, {}}, 20, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(test.smoothing.reason(), Reason::not_prepared);
  EXPECT_TRUE(test.run(std::vector<Point>(12, Point{0, 0, 0})).empty());
}

}  // namespace
}  // namespace glint
