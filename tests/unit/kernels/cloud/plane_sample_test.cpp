#include "kernels/cloud/plane_sample.hpp"

#include <cmath>
#include <tuple>

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

// Random numbers that draw all three points of a sample of three, in order.
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

// Each index takes 20 bits, mapped evenly to the sample; the four bits above are not read.
TEST(PlaneSample, DrawsAnyThreeOfItsPoints) {
  constexpr std::uint64_t k_points = 7;
  const std::vector<Point> points = random_points(7, 1, 3);
  TestSample test;
  test.add(points, points);
  const PlaneGate any{0.01f, 0};
  const auto first_of = [](std::uint64_t i) { return ((i << 20) + k_points - 1) / k_points; };
  for (std::uint64_t draw = 0; draw < 2 * 343; ++draw) {
    const std::uint64_t a = draw % 7, b = draw / 7 % 7, c = draw / 49 % 7;
    // The smallest and the largest 20-bit number that map to index i.
    const auto number_of = [&](std::uint64_t i) {
      return draw < 343 ? first_of(i) : first_of(i + 1) - 1;
    };
    const std::uint64_t drawn =
        number_of(a) | number_of(b) << 20 | number_of(c) << 40 | std::uint64_t{0xF} << 60;
    CandidatePlane found;
    const bool is_plane = test.sample.candidate_of(drawn, any, found);
    ASSERT_EQ(is_plane, a != b && b != c && a != c) << a << b << c;
    if (!is_plane) continue;
    const Vector3 from = vector_at(points, a);
    const Vector3 normal =
        (vector_at(points, b) - from).cross(vector_at(points, c) - from).normalized();
    ASSERT_LT((Vector3(found.nx, found.ny, found.nz) - normal).norm(), 1e-4) << a << b << c;
    ASSERT_NEAR(found.offset_m, normal.dot(from), 1e-4) << a << b << c;
  }
}

TEST(PlaneSample, TakesWhatIsExactlyAtItsGate) {
  const Point up{0, 0, 1};
  TestSample flat;
  flat.add({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {up, up, up});
  CandidatePlane found;
  EXPECT_TRUE(flat.sample.candidate_of(k_all_three, {0.01f, 1}, found));
  const float height = 0.0078125f, cosine = 0.75f;
  const PlaneGate gate{height, cosine};
  for (const auto& [z, along, on] : {std::tuple{height, cosine, 1}, std::tuple{-height, -cosine, 1},
                                     std::tuple{std::nextafter(height, 1.0f), 1.0f, 0},
                                     std::tuple{std::nextafter(-height, -1.0f), 1.0f, 0},
                                     std::tuple{0.0f, std::nextafter(cosine, 0.0f), 0}}) {
    TestSample test;
    test.add({{0.5f, 0.25f, z}}, {{0.5f, 0, along}});
    EXPECT_EQ(test.sample.score({0, 0, 1, 0}, gate), on) << z << ' ' << along;
  }
}

TEST(PlaneSample, HasNoCandidateOfWhatIsNoNumber) {
  const Point up{0, 0, 1};
  for (std::size_t wrong = 0; wrong < 3; ++wrong) {
    std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, normals(3, up);
    points[wrong][wrong] = k_not_a_number;
    TestSample test;
    test.add(points, normals);
    CandidatePlane found;
    EXPECT_FALSE(test.sample.candidate_of(k_all_three, {}, found));
    EXPECT_EQ(test.sample.score({}, {}), 2) << "a number's comparison with it is false";
  }
}

// Reference outputs of SplitMix64 (Steele, Lea and Flood), as the authors' program prints them.
TEST(PlaneSample, DrawsTheNumbersOfSplitMix64) {
  const std::uint64_t expected[] = {6457827717110365317u, 3203168211198807973u,
                                    9817491932198370423u, 4593380528125082431u,
                                    16408922859458223821u};
  for (int i = 0; i < 5; ++i) EXPECT_EQ(random_at(1234567, 0, i), expected[i]) << i;
  // Successive streams begin 2^40 numbers apart.
  constexpr std::uint64_t k_further = 0x9E3779B97F4A7C15u << 40;
  for (int stream = 0; stream < 5; ++stream) {
    EXPECT_EQ(random_at(7, stream + 1, 3), random_at(7 + k_further, stream, 3));
  }
}

TEST(PlaneSample, TakesTheMemoryThatItStatesAndRefusesLess) {
  ExactMemory enough(PlaneSample::bytes()), less(PlaneSample::bytes() - 1);
  PlaneSample sample;
  EXPECT_EQ(sample.prepare(enough.arena()), Reason::none);
  EXPECT_EQ(sample.prepare(less.arena()), Reason::not_prepared);
}

}  // namespace
}  // namespace glint
