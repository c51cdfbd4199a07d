#include "kernels/pose/best_rotation.hpp"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "kernels/motion/interpolate.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint {
namespace {

// Reference: singular value decomposition, which iterates until it has converged.
Quaternion by_svd(const Matrix3& c) {
  const Eigen::JacobiSVD<Matrix3> svd(c, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 u = svd.matrixU();
  if (u.determinant() * svd.matrixV().determinant() < 0) u.col(2) = -u.col(2);
  return Quaternion(Matrix3(u * svd.matrixV().transpose())).normalized();
}

constexpr std::array k_kinds = {"random",         "coplanar",      "mirrored",
                                "equal",          "nearly a line", "equal and coplanar",
                                "two equal ones", "ambiguous"};

Vector3 singular_values(test::Random& random, std::size_t kind) {
  const double t = random.uniform();
  switch (kind) {
    case 1:
      return {1, t, 0};
    case 2:
      return {1, t, -t * random.uniform()};
    case 3:
      return {1, 1, 1};
    case 4:
      return {1, 1e-3 * t + 2e-6, 1e-6 * random.normal()};
    case 5:
      return {1, 1, 0};
    case 6:
      return {1, t, t};
    default:
      return {1, t, -t * (1 - exponential(-18 * random.uniform()))};
  }
}

Matrix3 matrix_of(test::Random& random, std::size_t kind) {
  Matrix3 c;
  if (kind == 0) {
    for (int i = 0; i < 9; ++i) c(i) = random.normal();
    return c;
  }
  const Matrix3 u = random.rotation().toRotationMatrix();
  const Matrix3 v = random.rotation().toRotationMatrix();
  const double scale = exponential(random.within(-14, 5));
  c = u * singular_values(random, kind).asDiagonal() * v.transpose();
  return scale * c;
}

double trace_of(const Quaternion& rotation, const Matrix3& c) {
  return (rotation.toRotationMatrix().transpose() * c).trace();
}

TEST(BestRotation, IsAsGoodAsASingularValueDecompositionForAnyMatrix) {
  test::Random random(21);
  std::array<double, k_kinds.size()> worst{};
  for (std::size_t i = 0; i < 100'000; ++i) {
    const std::size_t kind = i % k_kinds.size();
    const Matrix3 c = matrix_of(random, kind);
    const Quaternion found = best_rotation(c);
    ASSERT_NEAR(found.norm(), 1.0, 1e-14);
    const double missing = (trace_of(by_svd(c), c) - trace_of(found, c)) / c.norm();
    worst[kind] = std::max(worst[kind], missing);
  }
  for (std::size_t kind = 0; kind < worst.size(); ++kind) {
    std::printf("  %s: at most %.1e of the norm is missing\n", k_kinds[kind], worst[kind]);
    EXPECT_LT(worst[kind], 1e-14) << k_kinds[kind];
  }
}

TEST(BestRotation, FindsTheRotationItselfToRounding) {
  test::Random random(22);
  for (int i = 0; i < 20'000; ++i) {
    const Quaternion truth = random.rotation();
    const Matrix3 spread =
        Vector3(1, random.within(0.1, 1), i % 2 == 0 ? 0.0 : random.uniform()).asDiagonal();
    const Quaternion found = best_rotation(truth.toRotationMatrix() * spread);
    ASSERT_LT(test::angle_between(found, truth), 1e-14);
  }
}

TEST(BestRotation, GivesTheSameBitsEverywhere) {
  test::Random random(23);
  test::BitHash hash;
  for (std::size_t i = 0; i < 8000; ++i) {
    hash.add(Pose{best_rotation(matrix_of(random, i % k_kinds.size())), Vector3::Zero()});
  }
  EXPECT_EQ(hash.value(), 15648917445715279792u);
}

TEST(TurnBetween, CarriesADirectionByTheLeastTurn) {
  test::Random random(9);
  for (int trial = 0; trial < 200; ++trial) {
    const Vector3 from = random.vector(1);
    const double angle = trial < 100 ? random.within(0, 3.14) : std::numbers::pi - 1e-9 * trial;
    const Vector3 axis = from.unitOrthogonal();
    const Vector3 to = 3 * (from_rotation_vector(angle * axis) * from);
    const Quaternion turn = rotation_between(from, to);
    EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 3e-7) << angle;
    EXPECT_NEAR(turn.norm(), 1, 1e-15);
    EXPECT_NEAR(rotation_vector(turn).norm(), angle, 3e-7);
  }
}

}  // namespace
}  // namespace glint
