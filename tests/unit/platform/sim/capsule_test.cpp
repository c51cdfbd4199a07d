#include "platform/sim/capsule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "platform/sim/random.hpp"

namespace glint::sim {
namespace {

double distance_to_axis(const Capsule& capsule, const Vector3& point) {
  const Vector3 axis = capsule.b - capsule.a;
  const double u = std::clamp((point - capsule.a).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
  return (capsule.a + u * axis - point).norm();
}

// Marches along the ray in small steps until it is inside the capsule; a reference method.
double marched(const Capsule& capsule, const Vector3& ray) {
  for (double range = 0; range < 2; range += 1e-4) {
    if (distance_to_axis(capsule, range * ray) < capsule.radius_m) return range;
  }
  return 0;
}

TEST(Capsule, IsHitWhereMarchingAlongTheRayMeetsIt) {
  const RandomKey key{1, Stream::room};
  int hits = 0;
  for (std::uint64_t i = 0; i < 120; ++i) {
    const Vector3 a = 0.15 * gaussian_vector(key, 3 * i) + Vector3(0, 0, 0.9);
    const Vector3 b = 0.15 * gaussian_vector(key, 3 * i + 1) + Vector3(0, 0, 0.9);
    const Vector3 aim = 0.15 * gaussian_vector(key, 3 * i + 2) + Vector3(0, 0, 0.9);
    const Capsule capsule{a, b, 0.08, 1};
    const Hit hit = TracedCapsule(capsule).trace(aim.normalized());
    const double expected = marched(capsule, aim.normalized());
    if (std::abs(distance_to_axis(capsule, expected * aim.normalized()) - 0.08) > 2e-4) continue;
    EXPECT_NEAR(hit.range_m, expected, 2e-3) << i;
    EXPECT_GE(hit.cosine, -1e-9);  // 0 if it missed
    EXPECT_LE(hit.cosine, 1 + 1e-9);
    hits += hit ? 1 : 0;
  }
  EXPECT_GT(hits, 15);
}

TEST(Capsule, IsABallWhereItsEndsMeet) {
  const Capsule ball{{0, 0, 1}, {0, 0, 1}, 0.1, 1};
  const Hit hit = TracedCapsule(ball).trace(Vector3::UnitZ());
  EXPECT_NEAR(hit.range_m, 0.9, 1e-12);
  EXPECT_NEAR(hit.cosine, 1, 1e-12);
  EXPECT_FALSE(TracedCapsule(ball).trace(Vector3(0.2, 0, 1).normalized()));
  EXPECT_FALSE(TracedCapsule(ball).trace(-Vector3::UnitZ()));
}

TEST(Capsule, KnowsHowNearALineOfSightPasses) {
  const Capsule across{{-0.1, 0.03, 0.4}, {0.1, 0.03, 0.4}, 0.01, 1};
  EXPECT_NEAR(axis_distance(across, Vector3(0, 0, 0.8)), 0.03, 1e-9);
  EXPECT_NEAR(axis_distance(across, Vector3(0, 0, 0.3)), std::hypot(0.1, 0.03), 1e-9);
  const Capsule aside{{0.2, 0, 0.4}, {0.3, 0, 0.4}, 0.01, 1};
  EXPECT_NEAR(axis_distance(aside, Vector3(0, 0, 0.8)), 0.2, 1e-9);
}

}  // namespace
}  // namespace glint::sim
