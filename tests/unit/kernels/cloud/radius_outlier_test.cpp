#include "kernels/cloud/radius_outlier.hpp"

#include <algorithm>
#include <cmath>

#include "clouds.hpp"
#include "walk_steps.hpp"

namespace glint {
namespace {

struct TestFilter {
  explicit TestFilter(int points, RadiusOutlierSettings settings = {})
      : memory(RadiusOutlier::bytes(points)) {
    EXPECT_EQ(filter.prepare(settings, points, memory.arena()), Reason::none);
  }
  std::vector<Point> run(const std::vector<Point>& points, int slice = 1 << 20,
                         int room = 1 << 16) {
    const TestCloud cloud(points);
    TestCloud kept(room);
    if (points.empty()) return run_on(PointCloud{}, slice, kept);
    return run_on(cloud.points, slice, kept);
  }
  std::vector<Point> run_on(const PointCloud& cloud, int slice, TestCloud& kept) {
    filter.begin(cloud);
    calls = 0;
    do {
      ++calls;
    } while (!filter.step(slice, kept.points));
    return kept.all();
  }
  TestMemory memory;
  RadiusOutlier filter;
  int calls = 0;
};

std::vector<Point> keep_by_brute_force(const std::vector<Point>& points, double radius,
                                       int neighbours) {
  std::vector<Point> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    int near = 0;
    for (std::size_t j = 0; j < points.size(); ++j) {
      near += i != j && squared_distance(points[i], points[j]) <= radius * radius ? 1 : 0;
    }
    if (near >= neighbours) kept.push_back(points[i]);
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

TEST(RadiusOutlier, KeepsWhatAPlainLoopKeeps) {
  std::vector<Point> points = random_points(2'000, 0.2f, 1);
  const std::vector<Point> sparse = random_points(500, 5.0f, 2);
  points.insert(points.end(), sparse.begin(), sparse.end());
  TestFilter test(4'000);
  std::vector<Point> kept = test.run(points);
  std::sort(kept.begin(), kept.end());
  EXPECT_EQ(kept, keep_by_brute_force(points, 0.05, 9));
  EXPECT_GT(kept.size(), 200u);
  EXPECT_LT(kept.size(), 2'300u);
  EXPECT_EQ(test.filter.reason(), Reason::none);
}

TEST(RadiusOutlier, GivesTheSameInSlicesAndSaysHowManyThereWere) {
  const std::vector<Point> points = random_points(1'000, 0.2f, 3);
  TestFilter test(1'000);
  const std::vector<Point> whole = test.run(points);
  EXPECT_EQ(test.calls, 6);  // five sorting passes and one filter pass
  EXPECT_EQ(test.run(points, 17), whole);
  EXPECT_EQ(test.calls, 6 * 59);
}

TEST(RadiusOutlier, CountsOthersNotThePointItself) {
  TestFilter test(20);
  EXPECT_TRUE(test.run(std::vector<Point>(9, Point{1, 1, 1})).empty());
  EXPECT_EQ(test.run(std::vector<Point>(10, Point{1, 1, 1})).size(), 10u);
}

TEST(RadiusOutlier, KeepsNothingOfNothingOfOnePointOrOfWhatIsNoNumber) {
  TestFilter test(100);
  EXPECT_TRUE(test.run({}).empty());
  EXPECT_TRUE(test.run({{0, 0, 0}}).empty());
  EXPECT_TRUE(test.run(std::vector<Point>(50, Point{k_not_a_number, 0, 0})).empty());
  EXPECT_EQ(test.filter.out_of_range(), 50);
  EXPECT_TRUE(test.run(std::vector<Point>(50, Point{100, 0, 0})).empty());
  EXPECT_EQ(test.filter.out_of_range(), 50);
}

TEST(RadiusOutlier, SaysWhenThereIsNoRoomAndKeepsTheFirst) {
  TestFilter test(20);
  const std::vector<Point> points(15, Point{0.5f, 0, 0});
  EXPECT_EQ(test.run(points, 4, 12).size(), 12u);
  EXPECT_EQ(test.filter.dropped(), 3);
  EXPECT_EQ(test.filter.reason(), Reason::cloud_full);
  // Five points exceed the grid; of its twenty, eight do not fit into the output.
  EXPECT_EQ(test.run(std::vector<Point>(25, Point{0.5f, 0, 0}), 4, 12).size(), 12u);
  EXPECT_EQ(test.filter.dropped(), 13);
}

// 1,000 points in the next cell, out of the radius: the search stops at candidates_max.
TEST(RadiusOutlier, DropsAPointWhoseCandidatesAreUsedUpAndSaysSo) {
  std::vector<Point> points(1'000, Point{0.098f, 0.001f, 0.001f});
  for (int i = 0; i < 10; ++i) points.push_back({0.001f, 0.001f, 0.001f});
  RadiusOutlierSettings few;
  few.neighbours_min = 12;
  few.candidates_max = 100;
  TestFilter test(2'000, few);
  EXPECT_EQ(test.run(points).size(), 1'000u);
  EXPECT_EQ(test.filter.candidates_exceeded(), 10);
  EXPECT_EQ(test.filter.reason(), Reason::search_full);
}

TEST(RadiusOutlier, RefusesWhatItCannotWorkWith) {
  TestMemory memory(RadiusOutlier::bytes(10));
  RadiusOutlier filter;
  EXPECT_EQ(filter.prepare({k_not_a_number, 9, 100}, 10, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(filter.prepare({0.05f, -1, 100}, 10, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(filter.prepare({0.05f, 9, 0}, 10, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(filter.prepare({}, 10'000, memory.arena()), Reason::not_prepared);
  TestCloud kept(1);
  filter.begin(kept.points);
  EXPECT_TRUE(filter.step(1, kept.points));
  EXPECT_EQ(filter.reason(), Reason::not_prepared);
}

// Coincident points are tested four at a time, until the required neighbours are found or the
// candidates are used up.
TEST(RadiusOutlier, CountsTheStepsOfEachFourCandidates) {
  const struct {
    int crowd, neighbours, candidates, looked_at;
    bool kept, undecided;
  } cases[] = {{30, 0, 4096, 4, true, false},    {30, 7, 4096, 8, true, false},
               {30, 8, 4096, 12, true, false},   {30, 29, 4096, 32, true, false},
               {30, 30, 4096, 32, false, false}, {30, 9, 10, 12, true, false},
               {30, 10, 10, 10, false, true},    {30, 1, 1, 1, false, true},
               {30, 0, 1, 4, true, false},       {12, 20, 10, 12, false, false},
               {13, 20, 12, 12, false, true}};
  for (const auto& c : cases) {
    TestFilter test(30, {0.05f, c.neighbours, c.candidates});
    const TestCloud crowd(std::vector<Point>(static_cast<std::size_t>(c.crowd), {0.02f, 0, 0}));
    for (const int slice : {1 << 20, 7, 1}) {
      TestCloud kept(30);
      test.filter.begin(crowd.points);
      int steps = 0;
      for (bool done = false; !done; steps += test.filter.steps()) {
        done = test.filter.step(slice, kept.points);
      }
      EXPECT_EQ(steps, sorting_steps(c.crowd, c.crowd) + k_single_cell_steps +
                           c.crowd * (k_outlier_steps + k_candidate_steps * c.looked_at))
          << c.neighbours << " of " << c.candidates << " by " << slice;
      EXPECT_EQ(kept.points.count, c.kept ? c.crowd : 0);
      EXPECT_EQ(test.filter.candidates_exceeded(), c.undecided ? c.crowd : 0);
    }
  }
}

// Of the last four candidates, one may be within the limit.
TEST(RadiusOutlier, TakesNoMoreStepsThanItStatesForOnePoint) {
  const RadiusOutlierSettings settings{0.05f, 4, 5};
  TestFilter test(30, settings);
  const TestCloud crowd(std::vector<Point>(30, {0.02f, 0, 0}));
  TestCloud kept(30);
  test.filter.begin(crowd.points);
  int steps = 0;
  while (!test.filter.step(1, kept.points) && kept.points.count == 0) {
  }
  steps = test.filter.steps();
  EXPECT_EQ(RadiusOutlier::steps_max(settings) - steps, k_worst_cell_extra_steps);
}

TEST(RadiusOutlier, CountsANeighbourAtExactlyTheRadius) {
  TestFilter test(2, {0.125f, 1, 100});
  EXPECT_EQ(test.run({{0, 0, 0}, {0.125f, 0, 0}}).size(), 2u);
  EXPECT_TRUE(test.run({{0, 0, 0}, {std::nextafter(0.125f, 1.0f), 0, 0}}).empty());
}

TEST(RadiusOutlier, KeepsTheWeightOfEachPoint) {
  TestCloud cloud(40), kept(40);
  for (int i = 0; i < 40; ++i) {
    const float place = 0.011f * static_cast<float>(i % 7);
    ASSERT_TRUE(cloud.points.add(place, -place, 0, static_cast<float>(i + 1)));
  }
  TestFilter test(40);
  test.run_on(cloud.points, 9, kept);
  ASSERT_EQ(kept.points.count, 40);
  std::vector<bool> found(40);
  for (int i = 0; i < 40; ++i) {
    const auto of = static_cast<int>(kept.points.weight[i]) - 1;
    EXPECT_EQ(kept.at(i), cloud.at(of));
    EXPECT_FALSE(found[static_cast<std::size_t>(of)]);
    found[static_cast<std::size_t>(of)] = true;
  }
}

TEST(RadiusOutlier, CountsAnewWhenBegunAgain) {
  TestFilter test(20, {0.05f, 9, 10});
  std::vector<Point> points(25, Point{0.5f, 0, 0});
  points[0][0] = k_not_a_number;
  TestCloud full(1);
  const TestCloud crowd(points);
  test.run_on(crowd.points, 5, full);
  EXPECT_EQ(test.filter.dropped(), 4 + 19);
  EXPECT_EQ(test.filter.out_of_range(), 1);
  EXPECT_EQ(test.filter.reason(), Reason::cloud_full);
  EXPECT_EQ(test.run(std::vector<Point>(12, Point{0, 0, 0})).size(), 12u);
  EXPECT_EQ(test.filter.dropped(), 0);
  EXPECT_EQ(test.filter.out_of_range(), 0);
  EXPECT_EQ(test.filter.reason(), Reason::none);
  TestFilter undecided(20, {0.05f, 10, 10});
  undecided.run(std::vector<Point>(20, Point{0, 0, 0}));
  EXPECT_EQ(undecided.filter.reason(), Reason::search_full);
  undecided.run({{0, 0, 0}});
  EXPECT_EQ(undecided.filter.candidates_exceeded(), 0);
  EXPECT_EQ(undecided.filter.reason(), Reason::none);
}

TEST(RadiusOutlier, TakesEachSettingAtItsLimitAndRefusesItBeyond) {
  const auto reason_of = [](const RadiusOutlierSettings& settings, int points = 10) {
    TestMemory memory(RadiusOutlier::bytes(10));
    return RadiusOutlier().prepare(settings, points, memory.arena());
  };
  for (const RadiusOutlierSettings& settings :
       {RadiusOutlierSettings{1e-38f, 9, 100}, {0.5f, 9, 100}, {0.05f, 0, 100}, {0.05f, 9, 1}}) {
    EXPECT_EQ(reason_of(settings), Reason::none);
  }
  for (const RadiusOutlierSettings& settings : {RadiusOutlierSettings{0, 9, 100},
                                                {-1, 9, 100},
                                                {1e-40f, 9, 100},
                                                {0.05f, -1, 100},
                                                {0.05f, 9, 0}}) {
    EXPECT_EQ(reason_of(settings), Reason::out_of_range)
        << settings.radius_m << ' ' << settings.neighbours_min << ' ' << settings.candidates_max;
  }
  EXPECT_EQ(reason_of({}, 0), Reason::out_of_range);
  EXPECT_EQ(reason_of({}, k_cloud_points_max), Reason::not_prepared);
  ExactMemory enough(RadiusOutlier::bytes(10)), less(RadiusOutlier::bytes(10) - 1);
  RadiusOutlier filter;
  EXPECT_EQ(filter.prepare({}, 10, enough.arena()), Reason::none);
  EXPECT_EQ(filter.reason(), Reason::none);
  EXPECT_EQ(filter.prepare({}, 10, less.arena()), Reason::not_prepared);
  EXPECT_EQ(filter.reason(), Reason::not_prepared) << "it is prepared no longer";
}

TEST(RadiusOutlier, IsPreparedNoLongerOnceASettingIsRefused) {
  TestFilter test(20);
  EXPECT_EQ(test.run(std::vector<Point>(12, Point{0, 0, 0})).size(), 12u);
  TestMemory memory(RadiusOutlier::bytes(20));
  EXPECT_EQ(test.filter.prepare({0.05f, -1, 100}, 20, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(test.filter.reason(), Reason::not_prepared);
  EXPECT_TRUE(test.run(std::vector<Point>(12, Point{0, 0, 0})).empty());
}

}  // namespace
}  // namespace glint
