#include "kernels/cloud/voxel_grid.hpp"

#include <cmath>
#include <map>

#include "clouds.hpp"

namespace glint {
namespace {

struct TestGrid {
  explicit TestGrid(int voxels, float voxel_m = 0.01f) : memory(VoxelGrid::bytes(voxels)) {
    EXPECT_EQ(grid.prepare({voxel_m}, voxels, memory.arena()), Reason::none);
  }
  void add(const TestCloud& cloud, int slice = 1 << 20) {
    for (int at = 0; at < cloud.points.count;) at = grid.add(cloud.points, at, slice);
  }
  [[nodiscard]] std::vector<Point> written(int slice = 1 << 20) const {
    TestCloud out(std::max(grid.count(), 1));
    for (int at = 0; at < grid.count();) at = grid.write(at, slice, out.points);
    return out.all();
  }
  TestMemory memory;
  VoxelGrid grid;
};

// Reference: voxel means with std::map, in the order of each voxel's first point.
std::vector<Point> plain_means(const std::vector<Point>& points, float voxel_m) {
  struct Sum {
    std::array<double, 3> sum{};
    int count = 0;
  };
  std::map<std::array<int, 3>, std::size_t> places;
  std::vector<Sum> sums;
  for (const Point& p : points) {
    std::array<int, 3> key;
    for (std::size_t i = 0; i < 3; ++i) {
      key[i] = static_cast<int>(std::floor(p[i] * (1 / voxel_m)));
    }
    const auto [place, is_new] = places.try_emplace(key, sums.size());
    if (is_new) sums.emplace_back();
    Sum& s = sums[place->second];
    for (std::size_t i = 0; i < 3; ++i) s.sum[i] += static_cast<double>(p[i]);
    ++s.count;
  }
  std::vector<Point> out;
  for (const Sum& s : sums) {
    out.push_back({static_cast<float>(s.sum[0] / s.count), static_cast<float>(s.sum[1] / s.count),
                   static_cast<float>(s.sum[2] / s.count)});
  }
  return out;
}

TEST(VoxelGrid, GivesTheMeanOfEachVoxelsPointsInTheOrderOfFirstPoints) {
  const std::vector<Point> points = random_points(20'000, 0.12f, 1);
  TestGrid test(20'000);
  test.add(TestCloud(points));
  EXPECT_EQ(test.written(), plain_means(points, 0.01f));
  EXPECT_EQ(test.grid.reason(), Reason::none);
}

TEST(VoxelGrid, GivesTheSameBitsFrameByFrameAndSliceBySlice) {
  const std::vector<Point> points = random_points(5'000, 0.1f, 2);
  const std::vector<Point> first(points.begin(), points.begin() + 2'000);
  const std::vector<Point> second(points.begin() + 2'000, points.end());
  TestGrid whole(5'000), sliced(5'000);
  whole.add(TestCloud(points));
  sliced.add(TestCloud(first), 7);
  sliced.add(TestCloud(second), 1);
  EXPECT_EQ(whole.written(), sliced.written(3));
}

TEST(VoxelGrid, KeepsTheFirstVoxelsWhenFullGoesOnFillingThemAndSaysSo) {
  TestGrid test(2, 1.0f);
  test.add(TestCloud(
      std::vector<Point>{{0.5f, 0, 0}, {1.5f, 0, 0}, {2.5f, 0, 0}, {0.25f, 0, 0}, {-0.5f, 0, 0}}));
  EXPECT_EQ(test.grid.reason(), Reason::cloud_full);
  EXPECT_EQ(test.grid.dropped(), 2);
  EXPECT_EQ(test.written(), (std::vector<Point>{{0.375f, 0, 0}, {1.5f, 0, 0}}));
}

TEST(VoxelGrid, LeavesOutAndCountsWhatIsBeyondTheGridOrNotFinite) {
  const float infinite = std::numeric_limits<float>::infinity();
  TestGrid test(8, 1.0f);
  test.add(TestCloud(std::vector<Point>{{k_not_a_number, 0, 0},
                                        {0, infinite, 0},
                                        {0, 0, -infinite},
                                        {1.1e6f, 0, 0},
                                        {0, -1.1e6f, 0},
                                        {1'048'575.0f, -1'048'575.0f, 0}}));
  EXPECT_EQ(test.grid.out_of_range(), 5);
  EXPECT_EQ(test.written(), (std::vector<Point>{{1'048'575.0f, -1'048'575.0f, 0}}));
}

TEST(VoxelGrid, GivesNothingOfNothingAndOnePointOfOneOrManyInOnePlace) {
  TestGrid test(8);
  TestCloud nothing(1);
  EXPECT_EQ(test.grid.add(nothing.points, 0, 100), 0);
  EXPECT_TRUE(test.written().empty());
  test.add(TestCloud(std::vector<Point>{{-0.003f, 0.002f, 0}}));
  EXPECT_EQ(test.written(), (std::vector<Point>{{-0.003f, 0.002f, 0}}));
  test.grid.clear();
  EXPECT_TRUE(test.written().empty());
  test.add(TestCloud(std::vector<Point>(1'000, Point{0.25f, 0.5f, 0.75f})));
  EXPECT_EQ(test.written(), (std::vector<Point>{{0.25f, 0.5f, 0.75f}}));
}

TEST(VoxelGrid, SaysHowManyMeasurementsAPointIsTheMeanOf) {
  TestGrid test(8, 1.0f);
  test.add(TestCloud(std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 0, 0}}));
  TestCloud out(8);
  test.grid.write(0, 8, out.points);
  EXPECT_EQ(out.points.weight[0], 3.0f);
  EXPECT_EQ(out.points.weight[1], 1.0f);
}

// Voxels whose keys hash to one slot: next to the first voxel alone, each costs two probes.
TEST(VoxelGrid, LooksAtAsManySlotsAsDeclaredAndDropsWhatHasNoneThere) {
  TestGrid test(2 * k_voxel_probes_max, 1.0f);
  const auto cost_of = [&](const Point& point) {
    const std::int64_t before = test.grid.probes();
    test.add(TestCloud(std::vector<Point>{point}));
    return test.grid.probes() - before;
  };
  std::vector<Point> same_slot{{0, 0, 0}};
  for (float x = 1; same_slot.size() < k_voxel_probes_max + 2; ++x) {
    test.grid.clear();
    test.add(TestCloud(std::vector<Point>{same_slot[0]}));
    if (cost_of({x, 0, 0}) == 2) same_slot.push_back({x, 0, 0});
  }
  test.grid.clear();
  for (int i = 0; i < k_voxel_probes_max; ++i) {
    EXPECT_EQ(cost_of(same_slot[static_cast<std::size_t>(i)]), i + 1);
    EXPECT_EQ(test.grid.count(), i + 1);
  }
  EXPECT_EQ(test.grid.dropped(), 0);
  for (std::size_t i = k_voxel_probes_max; i < same_slot.size(); ++i) {
    EXPECT_EQ(cost_of(same_slot[i]), k_voxel_probes_max);
  }
  EXPECT_EQ(test.grid.count(), k_voxel_probes_max);
  EXPECT_EQ(test.grid.dropped(), 2);
  EXPECT_EQ(test.grid.reason(), Reason::cloud_full) << "although there are voxels left";
}

// A voxel contains its lower boundary but not its upper one, for either sign.
TEST(VoxelGrid, PutsAPointOnABoundaryIntoTheVoxelAbove) {
  TestGrid test(8, 0.125f);
  test.add(TestCloud(std::vector<Point>{
      {0, 0, 0}, {0.0625f, 0, 0}, {0.125f, 0, 0}, {-0.125f, 0, 0}, {-0.0625f, 0, 0}}));
  EXPECT_EQ(test.written(),
            (std::vector<Point>{{0.03125f, 0, 0}, {0.125f, 0, 0}, {-0.09375f, 0, 0}}));
}

TEST(VoxelGrid, CountsAnewWhenPreparedAgain) {
  TestGrid test(1, 1.0f);
  test.add(TestCloud(std::vector<Point>{{0, 0, 0}, {1.5f, 0, 0}, {k_not_a_number, 0, 0}}));
  EXPECT_EQ(test.grid.dropped(), 1);
  EXPECT_EQ(test.grid.reason(), Reason::cloud_full) << "one is enough";
  TestMemory memory(VoxelGrid::bytes(4));
  ASSERT_EQ(test.grid.prepare({1.0f}, 4, memory.arena()), Reason::none);
  EXPECT_EQ(test.grid.dropped(), 0);
  EXPECT_EQ(test.grid.out_of_range(), 0);
  EXPECT_EQ(test.grid.count(), 0);
  EXPECT_EQ(test.grid.reason(), Reason::none);
  test.add(TestCloud(std::vector<Point>{{0, 0, 0}}));
  EXPECT_EQ(test.grid.prepare({0.0f}, 4, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(test.grid.count(), 0) << "it is prepared no longer";
  EXPECT_EQ(test.grid.reason(), Reason::not_prepared);
}

TEST(VoxelGrid, ForgetsAllWhenCleared) {
  TestGrid test(300), fresh(300);
  test.add(TestCloud(random_points(300, 0.1f, 3)));
  test.grid.clear();
  const std::vector<Point> points = random_points(300, 0.1f, 4);
  test.add(TestCloud(points));
  fresh.add(TestCloud(points));
  EXPECT_EQ(test.written(), fresh.written());
}

TEST(VoxelGrid, StopsWritingWhereTheCloudIsFull) {
  TestGrid test(10, 1.0f);
  test.add(TestCloud(std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
  TestCloud two(2);
  EXPECT_EQ(test.grid.write(0, 10, two.points), 2);
}

TEST(VoxelGrid, RefusesWhatItCannotWorkWith) {
  TestMemory memory(VoxelGrid::bytes(10));
  VoxelGrid grid;
  EXPECT_EQ(grid.prepare({0.0f}, 10, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(grid.prepare({k_not_a_number}, 10, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(grid.prepare({0.01f}, 0, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(grid.prepare({0.01f}, 1'000, memory.arena()), Reason::not_prepared);
  EXPECT_EQ(grid.reason(), Reason::not_prepared);
  EXPECT_EQ(grid.add(TestCloud(random_points(5, 1, 5)).points, 0, 5), 5);
  EXPECT_EQ(grid.count(), 0);
}

// Points exactly at the grid's end, on each axis and either side.
TEST(VoxelGrid, EndsAtTheSameVoxelAlongEachAxisAndEitherWay) {
  const float edge = static_cast<float>(k_voxel_range), inside = std::nextafter(edge, 0.0f);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      Point on{0, 0, 0}, within{0, 0, 0};
      on[axis] = side * edge;
      within[axis] = side * inside;
      TestGrid test(4, 1.0f);
      test.add(TestCloud(std::vector<Point>{on, within}));
      EXPECT_EQ(test.grid.out_of_range(), 1) << axis << ' ' << side;
      EXPECT_EQ(test.written(), std::vector<Point>{within}) << axis << ' ' << side;
    }
  }
}

TEST(VoxelGrid, LooksOnceForAllPointsThatShareAVoxelWithTheLast) {
  TestGrid test(8, 1.0f);
  const TestCloud cloud(std::vector<Point>(100, Point{0.5f, 0, 0}));
  test.add(cloud);
  EXPECT_EQ(test.grid.probes(), 1);
  test.add(cloud, 30);
  EXPECT_EQ(test.grid.probes(), 1 + 4) << "once a slice";
  TestCloud out(1);
  test.grid.write(0, 1, out.points);
  EXPECT_EQ(out.points.weight[0], 200);
}

TEST(VoxelGrid, CountsAnewWhenCleared) {
  TestGrid test(1, 1.0f);
  test.add(TestCloud(std::vector<Point>{{0, 0, 0}, {1.5f, 0, 0}, {k_not_a_number, 0, 0}}));
  EXPECT_EQ(test.grid.dropped(), 1);
  EXPECT_EQ(test.grid.out_of_range(), 1);
  const std::int64_t probes = test.grid.probes();
  test.grid.clear();
  EXPECT_EQ(test.grid.count(), 0);
  EXPECT_EQ(test.grid.dropped(), 0);
  EXPECT_EQ(test.grid.out_of_range(), 0);
  EXPECT_EQ(test.grid.reason(), Reason::none);
  EXPECT_EQ(test.grid.probes(), probes) << "counted since prepare()";
  test.add(TestCloud(std::vector<Point>{{1.5f, 0, 0}}));
  EXPECT_EQ(test.written(), (std::vector<Point>{{1.5f, 0, 0}}));
  TestMemory memory(VoxelGrid::bytes(1));
  ASSERT_EQ(test.grid.prepare({1.0f}, 1, memory.arena()), Reason::none);
  EXPECT_EQ(test.grid.probes(), 0);
}

TEST(VoxelGrid, AddsAndWritesNothingWhereNothingIsAskedFor) {
  TestGrid test(8, 1.0f);
  const TestCloud cloud(std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  for (const int most : {0, -5}) EXPECT_EQ(test.grid.add(cloud.points, 1, most), 1);
  EXPECT_EQ(test.grid.count(), 0);
  EXPECT_EQ(test.grid.add(cloud.points, 1, 1), 2);
  EXPECT_EQ(test.grid.add(cloud.points, 2, 100), 3);
  EXPECT_EQ(test.written(), (std::vector<Point>{{1, 0, 0}, {2, 0, 0}}));
  TestCloud out(8);
  for (const int most : {0, -5}) EXPECT_EQ(test.grid.write(1, most, out.points), 1);
  EXPECT_EQ(out.points.count, 0);
}

TEST(VoxelGrid, GoesOnWritingBehindWhereACloudWasFull) {
  TestGrid test(10, 1.0f);
  test.add(TestCloud(std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}));
  TestCloud first(2), second(2);
  const int at = test.grid.write(1, 10, first.points);
  EXPECT_EQ(at, 3);
  EXPECT_EQ(test.grid.write(at, 10, second.points), 4);
  EXPECT_EQ(first.all(), (std::vector<Point>{{1, 0, 0}, {2, 0, 0}}));
  EXPECT_EQ(second.all(), (std::vector<Point>{{3, 0, 0}}));
}

// The load factor is at most 1/2; the number of slots is a power of two.
TEST(VoxelGrid, TakesTheMemoryThatItStatesAndRefusesLess) {
  constexpr std::size_t k_voxel = 8 + 3 * 8 + 4 + 4;  // key, sums, points, slot
  VoxelGrid grid;
  for (int voxels = 1; voxels <= 40; ++voxels) {
    std::size_t slots = 2;
    while (slots < 2 * static_cast<std::size_t>(voxels)) slots *= 2;
    const std::size_t bytes = Arena::rounded(static_cast<std::size_t>(voxels) * k_voxel) +
                              Arena::rounded(slots * sizeof(std::int32_t));
    EXPECT_EQ(VoxelGrid::bytes(voxels), bytes) << voxels;
    ExactMemory enough(bytes), less(bytes - 1);
    EXPECT_EQ(grid.prepare({0.01f}, voxels, enough.arena()), Reason::none) << voxels;
    EXPECT_EQ(grid.prepare({0.01f}, voxels, less.arena()), Reason::not_prepared) << voxels;
  }
}

// At the limit the capacity itself is valid: the reason is missing memory.
TEST(VoxelGrid, TakesEachSettingAtItsLimitAndRefusesItBeyond) {
  const auto reason_of = [](float voxel_m, int voxels) {
    TestMemory memory(VoxelGrid::bytes(10));
    VoxelGrid grid;
    return grid.prepare({voxel_m}, voxels, memory.arena());
  };
  EXPECT_EQ(reason_of(0.01f, 1), Reason::none);
  EXPECT_EQ(reason_of(0.01f, k_cloud_points_max), Reason::not_prepared);
  EXPECT_EQ(reason_of(0.01f, k_cloud_points_max + 1), Reason::out_of_range);
  EXPECT_EQ(reason_of(1e-38f, 10), Reason::none);
  EXPECT_EQ(reason_of(1e-40f, 10), Reason::out_of_range) << "its inverse is infinite";
  EXPECT_EQ(reason_of(-0.01f, 10), Reason::out_of_range);
}

}  // namespace
}  // namespace glint
