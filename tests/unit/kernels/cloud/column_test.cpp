#include "kernels/cloud/column.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "clouds.hpp"

namespace glint {
namespace {

TEST(Arena, HandsOutZeroedPartsThatDoNotOverlapUntilNothingIsLeft) {
  alignas(Arena::k_alignment) std::array<std::byte, 3 * Arena::k_alignment> memory;
  memory.fill(std::byte{0x55});
  Arena arena(memory);
  Column<float> a, b, c;
  ASSERT_TRUE(a.reserve(16, arena));  // one cache line
  ASSERT_TRUE(b.reserve(17, arena));  // two cache lines
  EXPECT_FALSE(c.reserve(1, arena));
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(a.data()) % Arena::k_alignment, 0u);
  EXPECT_EQ(b.data() - a.data(), 16);
  for (int i = 0; i < 16; ++i) EXPECT_EQ(a[i], 0.0f);
  for (int i = 0; i < 17; ++i) EXPECT_EQ(b[i], 0.0f);
}

TEST(Arena, GivesWhatBytesSays) {
  for (const int points : {1, 15, 16, 17, 1000}) {
    TestMemory enough(PointCloud::bytes(points));
    PointCloud cloud;
    EXPECT_EQ(cloud.prepare(points, enough.arena()), Reason::none);
    std::vector<std::byte> small(PointCloud::bytes(points) - 1);
    Arena arena(small);
    EXPECT_EQ(cloud.prepare(points, arena), Reason::not_prepared);
    EXPECT_EQ(cloud.capacity, 0);
  }
}

TEST(PointCloud, RefusesACapacityBeyondItsRange) {
  TestMemory memory(64);
  PointCloud cloud;
  EXPECT_EQ(cloud.prepare(0, memory.arena()), Reason::out_of_range);
  EXPECT_EQ(cloud.prepare(k_cloud_points_max + 1, memory.arena()), Reason::out_of_range);
  EXPECT_FALSE(cloud.add(0, 0, 0));
}

// At any alignment of the memory, the first part begins at the first whole cache line.
TEST(Arena, BeginsAtTheFirstLineOfItsMemory) {
  alignas(Arena::k_alignment) std::array<std::byte, 5 * Arena::k_alignment> memory;
  for (std::size_t offset = 0; offset <= Arena::k_alignment; ++offset) {
    memory.fill(std::byte{0x55});
    Arena arena{std::span<std::byte>(memory).subspan(offset)};
    const std::size_t lines = offset == 0 ? 5 : 4;
    for (std::size_t line = 5 - lines; line < 5; ++line) {
      EXPECT_EQ(arena.take(1), memory.data() + line * Arena::k_alignment) << offset;
    }
    EXPECT_EQ(arena.take(1), nullptr) << offset;
  }
  Arena too_small{std::span<std::byte>(memory).subspan(1, 5)};
  EXPECT_EQ(too_small.take(1), nullptr);
}

TEST(Arena, ZeroesWhatWasAskedForAlone) {
  alignas(Arena::k_alignment) std::array<std::byte, Arena::k_alignment> memory;
  memory.fill(std::byte{0x55});
  Arena arena(memory);
  ASSERT_EQ(arena.take(5), memory.data());
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(memory[i], std::byte{0});
}

TEST(PointCloud, TakesTheLargestCapacityThatThereIsMemoryFor) {
  TestMemory memory(PointCloud::bytes(1));
  PointCloud cloud;
  EXPECT_EQ(cloud.prepare(k_cloud_points_max, memory.arena()), Reason::not_prepared);
  EXPECT_EQ(cloud.prepare(1, memory.arena()), Reason::none);
  EXPECT_EQ(cloud.capacity, 1);
}

TEST(PointCloud, AddsAPointWithoutANormalInThePlaceOfOneThatHadOne) {
  TestCloud cloud(2);
  PointCloud& points = cloud.points;
  for (int round = 0; round < 2; ++round) {
    points.count = 0;
    ASSERT_TRUE(points.add(1, 2, 3));
    ASSERT_TRUE(points.add(4, 5, 6, 7));
    EXPECT_FALSE(points.add(8, 9, 10)) << "full by one";
    EXPECT_EQ(points.count, 2);
    EXPECT_EQ(cloud.all(), (std::vector<Point>{{1, 2, 3}, {4, 5, 6}}));
    EXPECT_EQ(points.weight[0], 1);
    EXPECT_EQ(points.weight[1], 7);
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(points.normal_x[i], 0);
      EXPECT_EQ(points.normal_y[i], 0);
      EXPECT_EQ(points.normal_z[i], 0);
      points.normal_x[i] = points.normal_y[i] = points.normal_z[i] = 1;
    }
  }
}

TEST(PointCloud, PreparedAnewIsEmpty) {
  TestCloud cloud(3);
  ASSERT_TRUE(cloud.points.add(1, 2, 3));
  TestMemory memory(PointCloud::bytes(2));
  ASSERT_EQ(cloud.points.prepare(2, memory.arena()), Reason::none);
  EXPECT_EQ(cloud.points.count, 0);
  EXPECT_EQ(cloud.points.capacity, 2);
}

}  // namespace
}  // namespace glint
