#include "kernels/cloud/plane_sums.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>
#include <vector>

namespace glint {
namespace {

TEST(PlaneSums, HaveTheSmallestEigenvectorWhateverTheShape) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 3'000; ++round) {
    // Discs, rods, balls and intermediate shapes, randomly rotated.
    const Vector3 sizes(1, std::abs(normal(random)), 0.3 * std::abs(normal(random)));
    const Matrix3 turn = Quaternion(normal(random), normal(random), normal(random), normal(random))
                             .normalized()
                             .toRotationMatrix();
    PlaneSums sums;
    Matrix3 covariance = Matrix3::Zero();
    std::vector<Vector3> points;
    Vector3 mean = Vector3::Zero();
    for (int i = 0; i < 20; ++i) {
      const Vector3 local(normal(random), normal(random), normal(random));
      points.emplace_back(turn * local.cwiseProduct(sizes));
      mean += points.back() / 20;
      sums.add(points.back().x(), points.back().y(), points.back().z());
    }
    for (const Vector3& p : points) covariance += (p - mean) * (p - mean).transpose() / 20;
    const Eigen::SelfAdjointEigenSolver<Matrix3> solver(covariance);
    const FittedPlane plane = fit_plane(sums);
    EXPECT_NEAR(plane.variance, solver.eigenvalues()(0), 1e-13);
    EXPECT_NEAR(plane.in_plane_variance_min, solver.eigenvalues()(1), 1e-13);
    EXPECT_NEAR(plane.normal.norm(), 1, 1e-14);
    EXPECT_LT((plane.mean - mean).norm(), 1e-14);
    // Two nearly equal eigenvalues leave the vector undetermined: compare the variance along it.
    EXPECT_NEAR(plane.normal.dot(covariance * plane.normal), solver.eigenvalues()(0), 1e-13);
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
}

TEST(PlaneSums, HaveAUnitNormalAndNoSpreadForPointsOnALineOrInOnePlace) {
  PlaneSums line, place;
  for (int i = 0; i < 5; ++i) {
    line.add(0.1 * i, 0.2 * i, -0.1 * i);
    place.add(0.5, 0.25, -1);
  }
  EXPECT_NEAR(fit_plane(line).normal.norm(), 1, 1e-12);
  EXPECT_NEAR(fit_plane(line).normal.dot(Vector3(1, 2, -1)), 0, 1e-7);
  EXPECT_NEAR(fit_plane(line).in_plane_variance_min, 0, 1e-15);
  EXPECT_NEAR(fit_plane(place).normal.norm(), 1, 1e-12);
  EXPECT_NEAR(fit_plane(place).in_plane_variance_min, 0, 1e-15);
}

}  // namespace
}  // namespace glint
