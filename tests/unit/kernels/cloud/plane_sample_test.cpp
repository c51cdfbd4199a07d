#include "kernels/cloud/plane_sample.hpp"

#include <cmath>

#include "clouds.hpp"
#include "kernels/geometry.hpp"

namespace glint {
namespace {

Vector3 vector_at(const std::vector<Point>& points, std::size_t i) {
  return {static_cast<double>(points[i][0]), static_cast<double>(points[i][1]),
          static_cast<double>(points[i][2])};
}

struct TestSample {
  TestSample() : memory(PlaneSample::bytes()) {
    EXPECT_EQ(sample.prepare(memory.arena()), Reason::none);
  }
  void add(const std::vector<Point>& points, const std::vector<Point>& normals) {
    TestCloud cloud(points);
    for (int i = 0; i < cloud.points.count; ++i) {
      const Point& normal = normals[static_cast<std::size_t>(i)];
      cloud.points.normal_x[i] = normal[0];
      cloud.points.normal_y[i] = normal[1];
      cloud.points.normal_z[i] = normal[2];
      sample.add(cloud.points, i);
    }
  }
  TestMemory memory;
  PlaneSample sample;
};

// Of three points: these, in this order.
constexpr std::uint64_t k_third = (1u << 20) / 3 + 1;
constexpr std::uint64_t k_all_three = k_third << 20 | 2 * k_third << 40;

TEST(PlaneSample, CandidateIsThePlaneThroughItsThreePoints) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const std::vector<Point> points = random_points(3, 1, seed);
    const Vector3 a = vector_at(points, 0);
    const Vector3 across = (vector_at(points, 1) - a).cross(vector_at(points, 2) - a);
    if (across.norm() < 0.05) continue;
    const Vector3 normal = across.normalized();
    const Point up{static_cast<float>(normal.x()), static_cast<float>(normal.y()),
                   static_cast<float>(normal.z())};
    const Point down{-up[0], -up[1], -up[2]};
    TestSample test;
    test.add(points, {up, down, up});
    CandidatePlane found;
    ASSERT_TRUE(test.sample.candidate_of(k_all_three, {}, found)) << seed;
    EXPECT_LT((Vector3(found.nx, found.ny, found.nz) - normal).norm(), 1e-5) << seed;
    EXPECT_NEAR(found.offset_m, normal.dot(a), 1e-5) << seed;
    EXPECT_EQ(test.sample.score(found, {}), 3);
  }
}

TEST(PlaneSample, HasNoCandidateWhereOneOfItsPointsNormalsStandsAcross) {
  const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Point up{0, 0, 1};
  for (std::size_t tilted = 0; tilted < 3; ++tilted) {
    for (const float degrees : {19.0f, 21.0f}) {
      std::vector<Point> normals(3, up);
      const float angle = degrees * 0.01745329f;
      normals[tilted] = {std::sin(angle), 0, std::cos(angle)};
      TestSample test;
      test.add(points, normals);
      CandidatePlane found;
      EXPECT_EQ(test.sample.candidate_of(k_all_three, {}, found), degrees < 20) << tilted;
    }
  }
  TestSample line;
  line.add({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {up, up, up});
  CandidatePlane found;
  EXPECT_FALSE(line.sample.candidate_of(k_all_three, {}, found));
}

TEST(PlaneSample, ScoreIsAPlainCountOfPointsNearThePlaneWithItsNormal) {
  for (int count = 1; count < 40; ++count) {
    const auto seed = static_cast<std::uint64_t>(count);
    const std::vector<Point> points = random_points(count, 1, seed);
    const std::vector<Point> normals = random_points(count, 1, seed + 100);
    TestSample test;
    test.add(points, normals);
    const CandidatePlane plane{0.6f, -0.48f, 0.64f, 0.1f};
    const PlaneGate gate{0.4f, 0.3f};
    int expected = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3 n(0.6, -0.48, 0.64);
      expected += std::abs(n.dot(vector_at(points, i)) - 0.1) <= 0.4 &&
                          std::abs(n.dot(vector_at(normals, i))) >= 0.3
                      ? 1
                      : 0;
    }
    EXPECT_EQ(test.sample.score(plane, gate), expected) << count;
  }
}

TEST(PlaneSample, IsEmptyWhenClearedOrPreparedAnewAndFullAtItsCapacity) {
  const Point up{0, 0, 1};
  TestSample test;
  test.add(std::vector<Point>(k_plane_sample + 1, {0, 0, 0}),
           std::vector<Point>(k_plane_sample + 1, up));
  EXPECT_EQ(test.sample.count(), k_plane_sample);
  EXPECT_EQ(test.sample.score({}, {}), k_plane_sample);
  test.sample.clear();
  EXPECT_EQ(test.sample.score({}, {}), 0);
  test.add({{0, 0, 0}}, {up});
  TestMemory memory(PlaneSample::bytes());
  EXPECT_EQ(test.sample.prepare(memory.arena()), Reason::none);
  EXPECT_EQ(test.sample.count(), 0);
}

}  // namespace
}  // namespace glint
