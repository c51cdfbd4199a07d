// Poses compared with 4x4 matrices, rotations between directions, times, and names of reasons.
#include "kernels/geometry.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <set>
#include <string_view>

#include "kernels/reason.hpp"
#include "kernels/result.hpp"
#include "kernels/units.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint::geometry_test {
namespace {

using Matrix4 = Eigen::Matrix4d;

Matrix4 matrix_of(const Pose& pose) {
  Matrix4 matrix = Matrix4::Identity();
  matrix.topLeftCorner<3, 3>() = pose.rotation.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = pose.translation;
  return matrix;
}

TEST(Pose, MapsComposesAndInvertsAsAHomogeneousMatrix) {
  test::Random random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const Pose a{random.rotation(), random.vector(1)}, b{random.rotation(), random.vector(1)};
    const Vector3 point = random.vector(2);
    EXPECT_LT((a * point - (matrix_of(a) * point.homogeneous()).head<3>()).norm(), 1e-14);
    EXPECT_LT((matrix_of(a * b) - matrix_of(a) * matrix_of(b)).norm(), 1e-14);
    EXPECT_LT((matrix_of(a.inverse()) - matrix_of(a).inverse()).norm(), 1e-13);
  }
}

TEST(Pose, StaysARotationThroughManyCompositions) {
  test::Random random(2);
  const Pose step{random.rotation(), Vector3::Zero()};
  Pose pose;
  for (int i = 0; i < 10'000; ++i) pose = pose * step;
  EXPECT_NEAR(pose.rotation.norm(), 1, 1e-15);
}

TEST(CrossMatrix, TimesAVectorIsTheCrossProduct) {
  const Vector3 v(1, 2, 3);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(cross_matrix(v) * Vector3::Unit(axis), v.cross(Vector3::Unit(axis))) << axis;
  }
}

TEST(TurnBetween, TurnsHalfAroundBetweenOppositeDirectionsAndNotAtAllBetweenEqualOnes) {
  test::Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Vector3 from = random.vector(1);
    const Quaternion half = rotation_between(from, -2 * from);
    EXPECT_LT((half * from.normalized() + from.normalized()).norm(), 1e-6);
    EXPECT_NEAR(half.norm(), 1, 1e-14);
    EXPECT_LT(rotation_between(from, 3 * from).vec().norm(), 1e-15);
  }
  const Quaternion exact = rotation_between(Vector3::UnitX(), -Vector3::UnitX());
  EXPECT_EQ(exact.w(), 0);
  EXPECT_EQ(exact.vec().x(), 0) << "the axis is across the directions";
}

TEST(Units, AddAndScaleTimesAsIntegers) {
  constexpr Time late{700}, early{200};
  constexpr Duration gap{30};
  EXPECT_EQ(late - early, Duration{500});
  EXPECT_EQ(early - late, Duration{-500});
  EXPECT_EQ(late + gap, Time{730});
  EXPECT_EQ(late - gap, Time{670});
  EXPECT_EQ(gap + Duration{7}, Duration{37});
  EXPECT_EQ(gap - Duration{7}, Duration{23});
  EXPECT_EQ(gap * 4, Duration{120});
  EXPECT_EQ(milliseconds(3), Duration{3'000'000});
  EXPECT_EQ(microseconds(3), Duration{3'000});
  EXPECT_DOUBLE_EQ(milliseconds(2500).seconds(), 2.5);
  EXPECT_LT(early, late);
}

TEST(Reasons, HaveEachANameOfTheirOwnAndNoOtherValueHasOne) {
  std::set<std::string_view> names;
  for (int value = 0; value < 256; ++value) {
    const std::string_view name = name_of(static_cast<Reason>(value));
    if (value <= static_cast<int>(k_last_reason)) {
      EXPECT_TRUE(names.insert(name).second) << name;
      EXPECT_NE(name, "unknown") << value;
    } else {
      EXPECT_EQ(name, "unknown") << value;
    }
  }
  EXPECT_EQ(name_of(Reason::none), "none");
  EXPECT_EQ(name_of(k_last_reason), "ambiguous");
}

TEST(Reasons, OfAnOverrunAreTheFourPolicies) {
  const std::set<Reason> overruns{Reason::overrun_skipped, Reason::overrun_held,
                                  Reason::overrun_predicted, Reason::overrun_stopped};
  for (int value = 0; value < 256; ++value) {
    const auto reason = static_cast<Reason>(value);
    EXPECT_EQ(is_overrun(reason), overruns.contains(reason)) << value;
    EXPECT_EQ(static_cast<bool>(Result<int>{1, reason}), reason == Reason::none) << value;
  }
}

}  // namespace
}  // namespace glint::geometry_test
