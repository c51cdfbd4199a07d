#include "kernels/cloud/radius_outlier.hpp"

#include <algorithm>

#include "clouds.hpp"

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

std::vector<Point> plain(const std::vector<Point>& points, double radius, int neighbours) {
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
  EXPECT_EQ(kept, plain(points, 0.05, 9));
  EXPECT_GT(kept.size(), 200u);
  EXPECT_LT(kept.size(), 2'300u);
  EXPECT_EQ(test.filter.reason(), Reason::none);
}

TEST(RadiusOutlier, GivesTheSameInSlicesAndSaysHowManyThereWere) {
  const std::vector<Point> points = random_points(1'000, 0.2f, 3);
  TestFilter test(1'000);
  const std::vector<Point> whole = test.run(points);
  EXPECT_EQ(test.calls, 6);  // five passes to sort, one to judge
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
  // Five more than the grid holds, and eight of its twenty that find no room.
  EXPECT_EQ(test.run(std::vector<Point>(25, Point{0.5f, 0, 0}), 4, 12).size(), 12u);
  EXPECT_EQ(test.filter.dropped(), 13);
}

// A crowd in the next cell, but out of reach: the search ends all the same.
TEST(RadiusOutlier, DropsAPointWhoseCandidatesAreUsedUpAndSaysSo) {
  std::vector<Point> points(1'000, Point{0.098f, 0.001f, 0.001f});
  for (int i = 0; i < 10; ++i) points.push_back({0.001f, 0.001f, 0.001f});
  RadiusOutlierSettings few;
  few.neighbours_min = 12;
  few.candidates_max = 100;
  TestFilter test(2'000, few);
  EXPECT_EQ(test.run(points).size(), 1'000u);
  EXPECT_EQ(test.filter.undecided(), 10);
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

}  // namespace
}  // namespace glint
