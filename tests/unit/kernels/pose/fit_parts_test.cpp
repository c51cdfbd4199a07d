// Parts of the weighted fit: Cholesky factor, chi-square limits, whitened markers, lever arms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kernels/pose/chi_square_limit.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/pose_factor.hpp"
#include "kernels/pose/weighted_marker.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint::fit_parts_test {
namespace {

using test::Random;

TEST(PoseFactor, ReadsTheLowerHalfAlone) {
  Random random(4);
  Matrix6 root;
  for (int i = 0; i < 36; ++i) root(i) = random.normal();
  const Matrix6 matrix = root * root.transpose() + 0.1 * Matrix6::Identity();
  Matrix6 spoiled = matrix;
  for (int c = 1; c < 6; ++c)
    for (int r = 0; r < c; ++r) spoiled(r, c) = std::numeric_limits<double>::quiet_NaN();
  const Result<PoseFactor> a = pose_factor(matrix), b = pose_factor(spoiled);
  ASSERT_TRUE(b);
  EXPECT_EQ(a.value.inverse(), b.value.inverse());
  EXPECT_LT((a.value.inverse() - a.value.inverse().transpose()).norm(), 1e-300);
}

// A direction that only rounding determines counts as undetermined.
TEST(PoseFactor, IsNoneWhereADirectionHasLessThanATrillionthLeft) {
  for (const double left : {1e-11, 1e-13}) {
    Matrix6 matrix = Matrix6::Identity();
    matrix(3, 2) = matrix(2, 3) = 1;
    matrix(3, 3) = 1 + left;
    EXPECT_EQ(pose_factor(matrix).reason, left > 1e-12 ? Reason::none : Reason::degenerate) << left;
    EXPECT_EQ(pose_factor(Matrix6(1e6 * matrix)).reason, pose_factor(matrix).reason);
  }
  EXPECT_EQ(pose_factor(Matrix6(-Matrix6::Identity())).reason, Reason::degenerate);
  Matrix6 none = Matrix6::Identity();
  none(4, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(pose_factor(none).reason, Reason::degenerate);
}

// Upper tail of chi-square in closed form (Abramowitz and Stegun 26.4.4 and 26.4.5).
double tail(double chi_square, int degrees) {
  const double x = std::sqrt(chi_square);
  const double density = std::exp(-0.5 * chi_square);
  if (degrees % 2 == 0) {
    double term = 1, sum = 1;
    for (int r = 1; r <= (degrees - 2) / 2; ++r) sum += term *= chi_square / (2 * r);
    return density * sum;
  }
  double term = x, sum = degrees > 1 ? x : 0;
  for (int r = 2; r <= (degrees - 1) / 2; ++r) sum += term *= chi_square / (2 * r - 1);
  return std::erfc(x / std::sqrt(2.0)) + std::sqrt(2 / 3.14159265358979323846) * density * sum;
}

TEST(ChiSquareLimit, IsExceededOnceInTenThousand) {
  for (int degrees = 1; degrees <= 24; ++degrees)
    EXPECT_NEAR(tail(chi_square_limit(degrees), degrees) / k_chi_square_tail, 1, 1e-3) << degrees;
  for (const int none : {0, -1, -99}) EXPECT_EQ(chi_square_limit(none), 0);
  EXPECT_EQ(chi_square_limit(25), chi_square_limit(24));
}

TEST(WeightedMarker, RefusesEachFigureThatIsNotPositive) {
  const LocalRays rays{{256, 256}, {0, 0, 1}, {0.004, 0, 0}, {0, 0.004, 0}};
  const Vector3 model(0, 0, 0.1);
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [&](const MarkerVariance& variance, double range_m = 0.5) {
    return whiten_marker(model, rays, range_m, variance).reason == Reason::out_of_range;
  };
  EXPECT_FALSE(refused({0.01, 0, 0.02, 1e-6}));
  EXPECT_FALSE(refused({0.01, 0.009, 0.01, 1e-6}));
  EXPECT_FALSE(refused({2, 0, 3, 4}, 5)) << "however large";
  EXPECT_TRUE(refused({-0.01, 0, 0.02, 1e-6}));
  EXPECT_TRUE(refused({0.01, 0, -0.02, 1e-6}));
  EXPECT_TRUE(refused({0.01, 0.011, 0.01, 1e-6}));
  EXPECT_TRUE(refused({0.01, 0, 0.02, -1e-6}));
  EXPECT_TRUE(refused({0.01, 0, 0.02, 1e-6}, 0));
  EXPECT_TRUE(refused({none, 0, 0.02, 1e-6}));
  EXPECT_TRUE(refused({0.01, none, 0.02, 1e-6}));
  EXPECT_TRUE(refused({0.01, 0, 0.02, none}));
  LocalRays flat = rays;
  flat.along_y = Vector3::Zero();
  EXPECT_FALSE(whiten_marker(model, flat, 0.5, {}));
  flat = rays;
  flat.ray.x() = none;
  EXPECT_FALSE(whiten_marker(model, flat, 0.5, {}));
}

// Correlated pixel noise: the whitened residuals have unit covariance.
TEST(WeightedMarker, WhitensThePixelsCovariance) {
  const LocalRays rays{{100, 90}, {0, 0, 1}, {0.004, 0.001, 0}, {-0.0005, 0.003, 0}};
  const MarkerVariance variance{0.04, 0.012, 0.01, 0.003 * 0.003};
  const WeightedMarker marker = whiten_marker({0.1, 0.2, 0.3}, rays, 0.7, variance).value;
  EXPECT_EQ(marker.model_m, Vector3(0.1, 0.2, 0.3));
  EXPECT_EQ(marker.ray, rays.ray);
  EXPECT_EQ(marker.range_m, 0.7);
  EXPECT_EQ(marker.measured_m(), Vector3(0, 0, 0.7));
  EXPECT_NEAR(marker.per_range_sigma, 1 / 0.003, 1e-9);
  Eigen::Matrix2d by_pixel;  // derivatives of the residuals by the pixel
  for (int axis = 0; axis < 2; ++axis) {
    const Vector3 along = axis == 0 ? rays.along_x : rays.along_y;
    by_pixel(0, axis) = marker.across_first.dot(along);
    by_pixel(1, axis) = marker.across_second.dot(along);
  }
  Eigen::Matrix2d pixel;
  pixel << 0.04, 0.012, 0.012, 0.01;
  EXPECT_LT((by_pixel * pixel * by_pixel.transpose() - Eigen::Matrix2d::Identity()).norm(), 1e-12);
  EXPECT_NEAR(marker.across_first.dot(rays.ray), 0, 1e-12);
  EXPECT_NEAR(marker.across_second.dot(rays.ray), 0, 1e-12);
}

Pose nudged(const Pose& pose, const Vector6& by) {
  return {(from_rotation_vector(by.tail<3>()) * pose.rotation).normalized(),
          pose.translation + by.head<3>()};
}

TEST(LeverArm, IsThePointsDerivativeByThePose) {
  Random random(5);
  const Pose pose{random.rotation(), random.vector(0.4)};
  const Vector3 point = random.vector(0.2);
  const auto by_pose = point_by_pose(pose.rotation * point);
  const Matrix6 moved = pose_by_pose(pose.rotation * point);
  for (int i = 0; i < 6; ++i) {
    const Vector6 small = 1e-6 * Vector6::Unit(i);
    const Vector3 slope = (nudged(pose, small) * point - nudged(pose, -small) * point) / 2e-6;
    EXPECT_LT((by_pose.col(i) - slope).norm(), 1e-8) << i;
    EXPECT_LT((moved.col(i).head<3>() - slope).norm(), 1e-8) << i;
    EXPECT_EQ(Vector3(moved.col(i).tail<3>()), Vector3(Vector6::Unit(i).tail<3>()));
  }
}

TEST(LeverArm, MovesAndTurnsACovarianceAsItsJacobianDoes) {
  Random random(6);
  for (int trial = 0; trial < 50; ++trial) {
    Matrix6 root;
    for (int i = 0; i < 36; ++i) root(i) = random.normal();
    const Matrix6 covariance = root * root.transpose();
    const Vector3 lever = random.vector(1);
    const Matrix6 j = pose_by_pose(lever);
    EXPECT_LT((moved_covariance(covariance, lever) - j * covariance * j.transpose()).norm(), 1e-10);
    EXPECT_LT((moved_covariance(moved_covariance(covariance, lever), -lever) - covariance).norm(),
              1e-10);
    const Quaternion turn = random.rotation();
    const Matrix6 turned = rotated_covariance(covariance, turn);
    Vector6 a, b;
    a << random.vector(1), random.vector(1);
    b << turn * a.head<3>(), turn * a.tail<3>();
    EXPECT_NEAR(b.dot(turned * b), a.dot(covariance * a), 1e-9);
  }
}

// Largest row sum of magnitudes: an upper bound of the variance in any direction.
TEST(LeverArm, LargestVarianceIsThatOfTheLargestRow) {
  Matrix3 matrix;
  matrix << 3, -1, 0.5, -1, 5, -2, 0.5, -2, 4;
  EXPECT_DOUBLE_EQ(largest_variance(matrix), 8);
  Random random(7);
  for (int trial = 0; trial < 50; ++trial) {
    Matrix3 root;
    for (int i = 0; i < 9; ++i) root(i) = random.normal();
    const Matrix3 covariance = root * root.transpose();
    const double most = largest_variance(covariance);
    EXPECT_DOUBLE_EQ(most, covariance.cwiseAbs().rowwise().sum().maxCoeff());
    const Vector3 direction = random.vector(1).normalized();
    EXPECT_LE(direction.dot(covariance * direction), most);
  }
}
}  // namespace
}  // namespace glint::fit_parts_test
