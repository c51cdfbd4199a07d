#include "kernels/motion/cholesky.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "platform/dense.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint {
namespace {

TEST(Cholesky, SolvesAndInvertsWhatEigenDoes) {
  test::Random random(1);
  for (int trial = 0; trial < 500; ++trial) {
    const Matrix6 matrix = test::random_covariance<6>(random, 1);
    const Cholesky<6> factor(matrix);
    ASSERT_TRUE(factor.positive);
    const Matrix6 inverse = inverse_of(matrix);
    const double size = inverse.norm();
    EXPECT_LT((factor.inverse() - inverse).norm(), 1e-10 * size * size);
    Vector6 b;
    b << random.vector(1), random.vector(1);
    EXPECT_LT((matrix * factor.solve(b) - b).norm(), 1e-10 * matrix.norm() * size);
    EXPECT_NEAR(factor.squared_length(b), b.dot(inverse * b), 1e-9 * size * size);
  }
}

TEST(Cholesky, OfAKnownMatrixIsItsFactor) {
  Matrix3 matrix;
  matrix << 4, 2, -2, 2, 10, 5, -2, 5, 9;
  Matrix3 lower;
  lower << 2, 0, 0, 1, 3, 0, -1, 2, 2;
  EXPECT_EQ(Cholesky<3>(matrix).lower, lower);
}

TEST(Cholesky, ReadsTheLowerHalfAlone) {
  test::Random random(2);
  const Matrix6 matrix = test::random_covariance<6>(random, 1);
  Matrix6 spoiled = matrix;
  spoiled.triangularView<Eigen::StrictlyUpper>().setConstant(
      std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(Cholesky<6>(spoiled).positive);
  EXPECT_EQ(Cholesky<6>(spoiled).lower, Cholesky<6>(matrix).lower);
}

TEST(Cholesky, RefusesWhatIsNotPositive) {
  EXPECT_FALSE(Cholesky<3>(Matrix3::Zero()).positive);
  EXPECT_FALSE(Cholesky<3>(-Matrix3::Identity()).positive);
  Matrix3 matrix = Matrix3::Ones();  // rank 1
  EXPECT_FALSE(Cholesky<3>(matrix).positive);
  matrix = Matrix3::Identity();
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    matrix(2, 1) = bad;
    EXPECT_FALSE(Cholesky<3>(matrix).positive);
  }
}

}  // namespace
}  // namespace glint
