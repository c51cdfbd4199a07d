#include "platform/dense.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/kernels/pose/scene.hpp"

namespace glint::dense_test {
namespace {

// Returns a symmetric matrix of this rank; its nonzero eigenvalues are far from 0.
Eigen::MatrixXd symmetric(test::Random& random, int size, int rank) {
  Eigen::MatrixXd root(size, rank);
  for (int c = 0; c < rank; ++c)
    for (int r = 0; r < size; ++r) root(r, c) = random.normal() + (r == c ? 3 : 0);
  return root.lazyProduct(root.transpose());
}

double off(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return (a - b).norm() / b.norm(); }

TEST(Dense, FactorsInvertsAndSolves) {
  test::Random random(1);
  for (int size = 1; size <= 13; ++size) {
    const Eigen::MatrixXd a = symmetric(random, size, size);
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(size, size);
    const SymmetricEigen axes = symmetric_eigen(a);
    const Eigen::MatrixXd scaled = axes.vectors * axes.values.asDiagonal();
    EXPECT_LT(off(scaled.lazyProduct(axes.vectors.transpose()), a), 1e-12);
    EXPECT_LT(off(a.lazyProduct(inverse_of(a)), one), 1e-9);
    EXPECT_LT(off(a.lazyProduct(solve_symmetric(a, one)), one), 1e-9);
    const Eigen::MatrixXd root = inverse_root_of(a);
    EXPECT_LT(off(root.lazyProduct(a).eval().lazyProduct(root), one), 1e-9);
    EXPECT_DOUBLE_EQ(largest_sigma(a), std::sqrt(axes.values[size - 1]));
  }
}

// Penrose 1955, A generalized inverse for matrices, equations (1) to (4).
TEST(Dense, PseudoInverseMeetsPenrosesEquationsAtEveryRank) {
  test::Random random(2);
  for (int rank = 1; rank <= 6; ++rank) {
    const Eigen::MatrixXd a = symmetric(random, 6, rank), x = pseudo_inverse_of(a);
    const Eigen::MatrixXd ax = a.lazyProduct(x), xa = x.lazyProduct(a);
    EXPECT_LT(off(ax.lazyProduct(a), a), 1e-10) << rank;
    EXPECT_LT(off(xa.lazyProduct(x), x), 1e-10) << rank;
    EXPECT_LT(off(ax.transpose(), ax), 1e-10) << rank;
    EXPECT_LT(off(xa.transpose(), xa), 1e-10) << rank;
  }
}

}  // namespace
}  // namespace glint::dense_test
