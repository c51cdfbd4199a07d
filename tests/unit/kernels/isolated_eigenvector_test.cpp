// Most isolated eigenvector compared with Eigen's iterative solver; directions orthogonal to it.
#include "kernels/isolated_eigenvector.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "tests/unit/kernels/pose/scene.hpp"

namespace glint::isolated_eigenvector_test {
namespace {

SymmetricMatrix parts_of(const Matrix3& m) {
  return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
}

// R diag(values) R^T.
Matrix3 with_eigenvalues(test::Random& random, const Vector3& values) {
  const Matrix3 rotation = random.rotation().toRotationMatrix();
  return rotation * values.asDiagonal() * rotation.transpose();
}

// The root of x^3 - 3 x = 2 h above sqrt(3), by the trigonometric solution of the cubic.
TEST(LoneEigenvalue, IsTheTrigonometricSolutionOfItsCubic) {
  for (int i = -1000; i <= 1000; ++i) {
    const double h = i * 1e-3;
    const double expected = 2 * std::cos(std::acos(std::abs(h)) / 3);
    EXPECT_NEAR(detail::isolated_eigenvalue(h), h < 0 ? -expected : expected, 1e-14) << h;
  }
  EXPECT_NEAR(detail::isolated_eigenvalue(1 + 1e-9), 2, 1e-14) << "rounding beyond the range";
  EXPECT_NEAR(detail::isolated_eigenvalue(-1 - 1e-9), -2, 1e-14);
}

TEST(LoneEigenvector, IsThatOfTheEigenvalueFartherFromTheMiddleOne) {
  test::Random random(1);
  for (int trial = 0; trial < 500; ++trial) {
    const double size = std::pow(10.0, random.within(-6, 6));
    const Matrix3 m = with_eigenvalues(random, size * random.vector(1));
    const Eigen::SelfAdjointEigenSolver<Matrix3> solver(m);
    const Vector3 values = solver.eigenvalues() / size;
    const double above = values[2] - values[1], below = values[1] - values[0];
    if (std::abs(above - below) < 1e-3 || std::max(above, below) < 0.1) continue;
    const IsolatedEigenvector found = isolated_eigenvector(parts_of(m));
    EXPECT_EQ(found.largest, above > below) << trial;
    const Vector3 expected = solver.eigenvectors().col(above > below ? 2 : 0);
    EXPECT_NEAR(std::abs(found.v.dot(expected)), 1, 1e-13) << trial;
    EXPECT_NEAR(found.v.norm(), 1, 1e-14) << trial;
    const double value = found.v.dot(m * found.v);
    EXPECT_LT((m * found.v - value * found.v).norm(), 1e-12 * size) << trial;
  }
}

// Each axis isolated, above and below the other two, so that each pair of rows is selected once.
TEST(LoneEigenvector, IsTheAxisThatDiffersOfADiagonalMatrix) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double value : {5.0, 0.25}) {
      Vector3 diagonal(1, 1, 1);
      diagonal[axis] = value;
      const IsolatedEigenvector found = isolated_eigenvector(parts_of(diagonal.asDiagonal()));
      EXPECT_NEAR(std::abs(found.v[axis]), 1, 1e-15) << axis;
      EXPECT_EQ(found.largest, value > 1) << axis;
    }
  }
}

// If the middle eigenvalue is halfway, the largest one counts as the isolated one.
TEST(LoneEigenvector, IsTheLargestWhereBothGapsAreEqual) {
  for (int axis = 0; axis < 3; ++axis) {
    Vector3 diagonal = Vector3::Zero();
    diagonal[axis] = 1;
    diagonal[(axis + 1) % 3] = -1;
    const IsolatedEigenvector found = isolated_eigenvector(parts_of(diagonal.asDiagonal()));
    EXPECT_TRUE(found.largest);
    EXPECT_NEAR(std::abs(found.v[axis]), 1, 1e-15);
  }
}

TEST(LoneEigenvector, IsZWhereAllEigenvaluesAreEqual) {
  for (const double value : {0.0, 1.0, -3.5, 1e100}) {
    const IsolatedEigenvector found = isolated_eigenvector(parts_of(value * Matrix3::Identity()));
    EXPECT_EQ(found.v, Vector3::UnitZ()) << value;
    EXPECT_FALSE(found.largest) << value;
  }
}

TEST(DirectionsAcross, MakeARightHandedFrameWithAnyUnitVector) {
  test::Random random(4);
  for (int trial = 0; trial < 200; ++trial) {
    Vector3 n = random.vector(1).normalized();
    if (trial < 6) n = (trial < 3 ? 1 : -1) * Vector3::Unit(trial % 3);
    const OrthonormalBasis across = orthonormal_basis(n);
    Matrix3 frame;
    frame << across.p, across.q, n;
    EXPECT_LT((frame.transpose() * frame - Matrix3::Identity()).norm(), 1e-14) << n.transpose();
    EXPECT_NEAR(frame.determinant(), 1, 1e-14) << n.transpose();
  }
}

}  // namespace
}  // namespace glint::isolated_eigenvector_test
