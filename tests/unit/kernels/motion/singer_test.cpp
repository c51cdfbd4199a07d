#include "kernels/motion/singer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "tests/unit/kernels/pose/scene.hpp"

namespace glint {
namespace {

TEST(Singer, AgreesWithItsClosedFormWhereThatKeepsItsDigits) {
  for (const double damping : {2.4, 20.0, 55.0}) {
    for (const double t : {0.1, 0.25, 1.0}) {
      const SingerStep step = singer_step(damping, t);
      const double x = damping * t;
      EXPECT_NEAR(step.acceleration_decay, std::exp(-x), 1e-13);
      EXPECT_NEAR(step.velocity_by_acceleration, (1 - std::exp(-x)) / damping, 1e-13 * t);
      EXPECT_NEAR(step.position_by_acceleration, (x - 1 + std::exp(-x)) / (damping * damping),
                  1e-13 * t * t);
    }
  }
}

TEST(Singer, WithoutDampingIsConstantAcceleration) {
  const double t = 0.04;
  const SingerStep step = singer_step(0, t);
  EXPECT_DOUBLE_EQ(step.position_by_acceleration, t * t / 2);
  EXPECT_DOUBLE_EQ(step.velocity_by_acceleration, t);
  EXPECT_DOUBLE_EQ(step.acceleration_decay, 1);
  Matrix3 noise;  // white jerk of density 1
  noise << std::pow(t, 5) / 20, std::pow(t, 4) / 8, std::pow(t, 3) / 6, std::pow(t, 4) / 8,
      std::pow(t, 3) / 3, t * t / 2, std::pow(t, 3) / 6, t * t / 2, t;
  EXPECT_LT((step.noise - noise).cwiseQuotient(noise).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Singer, OfTwoHalvesIsTheWhole) {
  // Error of the quadrature, by damping * time.
  const std::pair<double, double> k_limits[] = {
      {0.0, 1e-14}, {1e-3, 1e-13}, {2.4, 1e-9}, {24.0, 1e-5}, {125.0, 1e-2}};
  for (const auto& [damping, limit] : k_limits) {
    const auto matrix = [](const SingerStep& step) {
      Matrix3 f;
      f << 1, step.seconds, step.position_by_acceleration, 0, 1, step.velocity_by_acceleration, 0,
          0, step.acceleration_decay;
      return f;
    };
    const SingerStep half = singer_step(damping, 0.02);
    const SingerStep whole = singer_step(damping, 0.04);
    const Matrix3 f = matrix(half);
    EXPECT_LT((f * f - matrix(whole)).norm(), 1e-14);
    const Matrix3 noise = f * half.noise * f.transpose() + half.noise;
    EXPECT_LT((noise - whole.noise).cwiseQuotient(whole.noise).cwiseAbs().maxCoeff(), limit)
        << damping;
  }
}

TEST(Singer, SeriesAndClosedFormMeet) {
  const SingerStep below = singer_step(1, 0.1 - 1e-12), above = singer_step(1, 0.1 + 1e-12);
  EXPECT_NEAR(below.position_by_acceleration, above.position_by_acceleration, 1e-12);
  EXPECT_NEAR(below.acceleration_decay, above.acceleration_decay, 1e-11);
}

TEST(Singer, InNoTimeMovesNothing) {
  const SingerStep step = singer_step(55, 0);
  EXPECT_EQ(step.position_by_acceleration, 0);
  EXPECT_EQ(step.velocity_by_acceleration, 0);
  EXPECT_EQ(step.acceleration_decay, 1);
  EXPECT_EQ(step.noise, Matrix3::Zero());
}

TEST(Singer, GivesTheSameBitsEverywhere) {
  test::Random random(1);
  test::BitHash hash;
  for (int trial = 0; trial < 2000; ++trial) {
    const double damping = random.within(0, 60);
    const SingerStep step = singer_step(damping, random.within(0, 1));
    hash.add(step.position_by_acceleration);
    for (int i = 0; i < 9; ++i) hash.add(step.noise(i / 3, i % 3));
  }
  EXPECT_EQ(hash.value(), 4064670152720070781u);
}

}  // namespace
}  // namespace glint
