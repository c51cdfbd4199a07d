#include "kernels/motion/interpolate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/kernels/pose/scene.hpp"

namespace glint {
namespace {

Quaternion turned(const Vector3& axis, double angle) {
  return from_rotation_vector(angle * axis.normalized());
}

TimedPose random_stamped(std::int64_t ms, test::Random& random) {
  const Quaternion rotation = random.rotation();
  return {Time{ms * 1'000'000}, {rotation, random.vector(1)}};
}

TimedPose stamped(std::int64_t ms, const Quaternion& rotation, const Vector3& place) {
  return {Time{ms * 1'000'000}, {rotation, place}};
}

TEST(Slerp, TurnsAtConstantRateAboutOneAxisInsideAndOutside) {
  test::Random random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vector3 axis = random.vector(1).normalized();
    const double angle = random.within(1e-7, 3.1);
    const Quaternion start = random.rotation();
    const Quaternion end = turned(axis, angle) * start;
    for (const double u : {-3.0, -0.5, 0.0, 0.25, 0.5, 1.0, 2.5}) {
      const Quaternion expected = turned(axis, u * angle) * start;
      EXPECT_LT(test::angle_between(slerp(start, end, u), expected), 2e-14) << angle << " " << u;
    }
  }
}

TEST(Slerp, TakesTheShorterArcWhateverTheSignOfTheQuaternion) {
  const Quaternion start = Quaternion::Identity();
  const Quaternion end = turned(Vector3::UnitZ(), 0.4);
  const Quaternion opposite(-end.w(), -end.x(), -end.y(), -end.z());
  const Quaternion expected = turned(Vector3::UnitZ(), 0.2);
  EXPECT_LT(test::angle_between(slerp(start, opposite, 0.5), expected), 1e-15);
  EXPECT_LT(test::angle_between(slerp(start, end, 0.5), expected), 1e-15);
}

TEST(Slerp, OfEqualOrNearlyEqualRotationsIsThatRotation) {
  test::Random random(2);
  const Quaternion q = random.rotation();
  for (const double u : {-10.0, 0.0, 0.3, 1.0, 10.0}) {
    EXPECT_LT(test::angle_between(slerp(q, q, u), q), 4e-15);
    for (const double angle : {1e-300, 1e-16, 1e-9, 1e-8, 2e-8}) {
      const Quaternion near = turned(Vector3::UnitX(), angle) * q;
      EXPECT_LT(test::angle_between(slerp(q, near, u), q), 10.1 * angle + 4e-15) << angle;
    }
  }
}

TEST(Slerp, OfAHalfTurnStaysAUnitQuaternionOnTheWay) {
  const Quaternion half = turned(Vector3::UnitY(), std::numbers::pi);
  for (const double u : {0.0, 0.25, 0.5, 1.0, 1.5}) {
    const Quaternion q = slerp(Quaternion::Identity(), half, u);
    EXPECT_NEAR(q.norm(), 1.0, 1e-15);
    EXPECT_NEAR(test::angle_between(q, Quaternion::Identity()),
                u <= 1 ? u * std::numbers::pi : 0.5 * std::numbers::pi, 1e-14);
  }
}

TEST(Interpolate, MovesInAStraightLineAtConstantVelocity) {
  const auto a = stamped(100, Quaternion::Identity(), {0, 0, 1});
  const auto b = stamped(122, turned(Vector3::UnitX(), 0.1), {0.022, 0, 1});
  const Pose middle = interpolate(a, b, Time{111'000'000});
  EXPECT_LT((middle.translation - Vector3(0.011, 0, 1)).norm(), 1e-15);
  EXPECT_NEAR(test::angle_between(middle.rotation, a.pose.rotation), 0.05, 1e-15);
  EXPECT_EQ(interpolate(a, b, Time{0}).translation, a.pose.translation);
  EXPECT_EQ(interpolate(a, b, Time{999'000'000}).translation, b.pose.translation);
}

TEST(Extrapolate, GoesOnUntilTheHorizonAndStaysThere) {
  const auto a = stamped(100, Quaternion::Identity(), {0, 0, 1});
  const auto b = stamped(110, turned(Vector3::UnitX(), 0.1), {0.01, 0, 1});
  const Pose later = extrapolate(a, b, Time{120'000'000}, milliseconds(50));
  EXPECT_LT((later.translation - Vector3(0.02, 0, 1)).norm(), 1e-15);
  EXPECT_NEAR(test::angle_between(later.rotation, a.pose.rotation), 0.2, 1e-14);
  const Pose at_horizon = extrapolate(a, b, Time{160'000'000}, milliseconds(50));
  const Pose beyond = extrapolate(a, b, Time{1'000'000'000}, milliseconds(50));
  EXPECT_LT((beyond.translation - Vector3(0.06, 0, 1)).norm(), 1e-15);
  EXPECT_EQ(beyond.translation, at_horizon.translation);
  EXPECT_EQ(beyond.rotation.coeffs(), at_horizon.rotation.coeffs());
}

TEST(Extrapolate, WithStampsThatDoNotRiseGivesTheNewerPose) {
  const auto a = stamped(100, Quaternion::Identity(), {0, 0, 1});
  for (const std::int64_t ms : {100, 90}) {
    const auto b = stamped(ms, turned(Vector3::UnitX(), 0.1), {0.01, 0, 1});
    EXPECT_EQ(extrapolate(a, b, Time{200'000'000}, milliseconds(50)).translation,
              b.pose.translation);
    EXPECT_EQ(interpolate(a, b, Time{95'000'000}).translation, b.pose.translation);
    EXPECT_EQ(velocity_between(a, b).linear_m_s, Vector3::Zero());
    EXPECT_EQ(velocity_between(a, b).angular_rad_s, Vector3::Zero());
  }
}

TEST(Velocity, CarriesOnePoseToTheOther) {
  test::Random random(3);
  for (int trial = 0; trial < 1000; ++trial) {
    const auto a = random_stamped(0, random);
    const Vector3 linear = random.vector(1);
    const Vector3 angular = random.vector(2);
    const Quaternion end = from_rotation_vector(0.05 * angular) * a.pose.rotation;
    const auto b = stamped(50, end, a.pose.translation + 0.05 * linear);
    const Velocity velocity = velocity_between(a, b);
    EXPECT_LT((velocity.linear_m_s - linear).norm(), 1e-13);
    EXPECT_LT((velocity.angular_rad_s - angular).norm(), 1e-13);
  }
}

TEST(RotationVector, ComesBackFromItsQuaternion) {
  test::Random random(4);
  for (int trial = 0; trial < 2000; ++trial) {
    const double angle = trial % 2 == 0 ? random.within(0, 3.14) : 1e-10 * random.uniform();
    const Vector3 vector = angle * random.vector(1).normalized();
    EXPECT_LT((rotation_vector(from_rotation_vector(vector)) - vector).norm(), 1e-14);
  }
  EXPECT_EQ(rotation_vector(Quaternion::Identity()), Vector3::Zero());
}

TEST(Motion, GivesTheSameBitsEverywhere) {
  test::Random random(5);
  test::BitHash hash;
  for (int trial = 0; trial < 5000; ++trial) {
    const auto a = random_stamped(0, random);
    const auto b = random_stamped(22, random);
    const Time t{random.below(60'000'000)};
    hash.add(extrapolate(a, b, t, milliseconds(100)));
    const Velocity velocity = velocity_between(a, b);
    for (int i = 0; i < 3; ++i) {
      hash.add(velocity.linear_m_s(i));
      hash.add(velocity.angular_rad_s(i));
    }
  }
  EXPECT_EQ(hash.value(), 8231301955763690519u);
}

}  // namespace
}  // namespace glint
