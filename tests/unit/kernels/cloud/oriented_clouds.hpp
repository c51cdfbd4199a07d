// Point clouds with normals for tests, and a plane search over them.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "clouds.hpp"
#include "kernels/cloud/plane_support.hpp"
#include "kernels/cloud/planes.hpp"

namespace glint {

struct PointWithNormal {
  Point point;
  Point normal;
};

inline TestCloud cloud_of(const std::vector<PointWithNormal>& points) {
  TestCloud cloud(static_cast<int>(points.size()));
  for (const PointWithNormal& p : points) {
    const int i = cloud.points.count;
    EXPECT_TRUE(cloud.points.add(p.point[0], p.point[1], p.point[2]));
    cloud.points.normal_x[i] = p.normal[0];
    cloud.points.normal_y[i] = p.normal[1];
    cloud.points.normal_z[i] = p.normal[2];
  }
  return cloud;
}

struct TestSearch {
  explicit TestSearch(int points, PlaneSettings settings = {})
      : memory(PlaneSearch::bytes(points) + PlaneSupport::bytes(points)) {
    EXPECT_EQ(search.prepare(settings, points, memory.arena()), Reason::none);
    PlaneSupportSettings wide;  // the test's floors are sparse
    wide.radius_m = 0.2f;
    EXPECT_EQ(support.prepare(wide, points, memory.arena()), Reason::none);
  }
  void run(const PointCloud& points, int slice = 1 << 20) {
    search.begin(points);
    while (!search.step(slice)) {
    }
    support.begin(points, search);
    while (!support.step(slice)) {
    }
  }
  TestMemory memory;
  PlaneSearch search;
  PlaneSupport support;
};

// Scene: a floor of 6,000 points, a wall of 3,000, 1,500 scattered, and 400 on the floor's plane
// with normals across it. 3 mm noise; normals are a few degrees off and of either sign.
inline std::vector<PointWithNormal> scene_points(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> side(-1, 1);
  std::normal_distribution<float> noise(0, 0.003f), tilt(0, 0.05f);
  std::vector<PointWithNormal> out;
  const auto sign = [&] { return random() % 2 == 0 ? 1.0f : -1.0f; };
  const auto unit = [](float x, float y, float z) {
    const float length = std::sqrt(x * x + y * y + z * z);
    return Point{x / length, y / length, z / length};
  };
  for (int i = 0; i < 6'000; ++i) {
    out.push_back({{side(random), side(random), 0.5f + noise(random)},
                   unit(tilt(random), tilt(random), sign())});
  }
  for (int i = 0; i < 3'000; ++i) {
    out.push_back({{-1 + noise(random), side(random), 0.5f * (1 + side(random))},
                   unit(sign(), tilt(random), tilt(random))});
  }
  for (int i = 0; i < 1'500; ++i) {
    out.push_back({{side(random), side(random), side(random)},
                   unit(side(random), side(random), side(random))});
  }
  for (int i = 0; i < 400; ++i) {
    out.push_back({{side(random), side(random), 0.5f}, {0, 1, 0}});
  }
  return out;
}

// A grid with 1 cm spacing and `across` points a row, at height z, all with this normal.
inline std::vector<PointWithNormal> tile(int points, int across, float z, const Point& normal) {
  std::vector<PointWithNormal> out;
  for (int i = 0; i < points; ++i) {
    out.push_back(
        {{0.01f * static_cast<float>(i % across), 0.01f * static_cast<float>(i / across), z},
         normal});
  }
  return out;
}

}  // namespace glint
