// Test point clouds that own their memory; random points and a noisy curved surface.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "kernels/cloud/point_cloud.hpp"

namespace glint {

using Point = std::array<float, 3>;

inline constexpr float k_not_a_number = std::numeric_limits<float>::quiet_NaN();

// Memory for the arena that a kernel is prepared with.
class TestMemory {
 public:
  explicit TestMemory(std::size_t bytes) : bytes_(bytes + Arena::k_alignment), arena_(bytes_) {}
  [[nodiscard]] Arena& arena() { return arena_; }

 private:
  std::vector<std::byte> bytes_;
  Arena arena_;
};

// Exactly `bytes` bytes from the start of a cache line: an arena over it loses none to alignment.
class ExactMemory {
 public:
  explicit ExactMemory(std::size_t bytes) : bytes_(bytes + Arena::k_alignment) {
    void* begin = bytes_.data();
    std::size_t room = bytes_.size();
    std::align(Arena::k_alignment, bytes, begin, room);
    arena_ = Arena({static_cast<std::byte*>(begin), bytes});
  }
  [[nodiscard]] Arena& arena() { return arena_; }

 private:
  std::vector<std::byte> bytes_;
  Arena arena_{std::span<std::byte>()};
};

struct TestCloud {
  explicit TestCloud(int capacity) : memory(PointCloud::bytes(std::max(capacity, 1))) {
    EXPECT_EQ(points.prepare(std::max(capacity, 1), memory.arena()), Reason::none);
  }
  explicit TestCloud(const std::vector<Point>& of) : TestCloud(static_cast<int>(of.size())) {
    for (const Point& p : of) EXPECT_TRUE(points.add(p[0], p[1], p[2]));
  }
  [[nodiscard]] Point at(int i) const { return {points.x[i], points.y[i], points.z[i]}; }
  [[nodiscard]] std::vector<Point> all() const {
    std::vector<Point> out;
    for (int i = 0; i < points.count; ++i) out.push_back(at(i));
    return out;
  }
  TestMemory memory;
  PointCloud points;
};

inline double squared_distance(const Point& a, const Point& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double d = static_cast<double>(a[i]) - static_cast<double>(b[i]);
    sum += d * d;
  }
  return sum;
}

// Uniform in the cube [-half, half]^3 about the origin.
inline std::vector<Point> random_points(int count, float half, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> side(-half, half);
  std::vector<Point> out;
  for (int i = 0; i < count; ++i) out.push_back({side(random), side(random), side(random)});
  return out;
}

// Noisy grid of side x side points on a gently curved surface; normals are near +z.
inline std::vector<Point> curved_surface_points(int side, float spacing, float noise,
                                                std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> shift(-1, 1);
  std::vector<Point> out;
  for (int i = 0; i < side * side; ++i) {
    const float x = spacing * static_cast<float>(i % side - side / 2) + noise * shift(random);
    const float y = spacing * static_cast<float>(i / side - side / 2) + noise * shift(random);
    out.push_back({x, y, 0.8f * x * x - 0.5f * x * y + 0.1f * y + noise * shift(random)});
  }
  return out;
}

}  // namespace glint
