#include "kernels/cloud/column.hpp"

#include <gtest/gtest.h>

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
  ASSERT_TRUE(b.reserve(17, arena));  // two
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

}  // namespace
}  // namespace glint
