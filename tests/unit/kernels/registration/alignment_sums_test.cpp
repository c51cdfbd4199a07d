#include "kernels/registration/alignment_sums.hpp"
#include "platform/dense.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace glint::alignment_sums_test {
namespace {

struct Row {
  Vector3 lever, gradient;
  double residual, weight;
};

std::vector<Row> random_rows(int count, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vector = [&] {
    const double x = any(random), y = any(random);
    return Vector3(x, y, any(random));
  };
  std::vector<Row> rows;
  for (int i = 0; i < count; ++i) {
    const Vector3 lever = vector(), gradient = vector();
    const double residual = any(random);
    rows.push_back({lever, gradient, residual, 1.5 + any(random)});
  }
  return rows;
}

// Derivative of a residual by a translation and a rotation about the origin of the levers.
Vector6 derivative_of(const Row& row) {
  Vector6 derivative;
  derivative << row.gradient, row.lever.cross(row.gradient);
  return derivative;
}

TEST(AlignmentSums, AreThoseOfTheWeightedNormalEquations) {
  std::mt19937 random(1);
  AlignmentSums sums;
  Matrix6 matrix = Matrix6::Zero();
  Vector6 slope = Vector6::Zero();
  double squares = 0;
  for (const Row& row : random_rows(20, random)) {
    sums.add(row.lever, row.gradient, row.residual, row.weight);
    const Vector6 derivative = derivative_of(row);
    matrix += row.weight * derivative * derivative.transpose();
    slope += row.weight * row.residual * derivative;
    squares += row.weight * row.residual * row.residual;
  }
  const Matrix6 whole = sums.matrix.selfadjointView<Eigen::Lower>();
  EXPECT_LT((whole - matrix).norm(), 1e-13);
  EXPECT_LT((sums.slope - slope).norm(), 1e-13);
  EXPECT_NEAR(sums.squares, squares, 1e-13);
  EXPECT_EQ(sums.count, 20);
}

TEST(AlignmentSums, GiveTheMotionWithTheLeastSquares) {
  std::mt19937 random(2);
  for (int round = 0; round < 20; ++round) {
    AlignmentSums sums;
    Matrix6 matrix = Matrix6::Zero();
    Vector6 slope = Vector6::Zero();
    for (const Row& row : random_rows(12, random)) {
      sums.add(row.lever, row.gradient, row.residual, row.weight);
      const Vector6 derivative = derivative_of(row);
      matrix += row.weight * derivative * derivative.transpose();
      slope += row.weight * row.residual * derivative;
    }
    const Vector6 expected = solve_symmetric(matrix, -slope);
    const Result<AlignmentStep> step = solve(sums);
    ASSERT_EQ(step.reason, Reason::none);
    EXPECT_LT((step.value.translation - expected.head<3>()).norm(), 1e-9 * expected.norm());
    EXPECT_LT((step.value.rotation - expected.tail<3>()).norm(), 1e-9 * expected.norm());
  }
}

TEST(AlignmentSums, HaveNoMotionWhereADirectionIsOpen) {
  AlignmentSums sums;
  EXPECT_EQ(solve(sums).reason, Reason::degenerate);
  for (int i = 0; i < 20; ++i) {
    sums.add(Vector3(0.1 * i, 0.02 * i * i, 0), Vector3::UnitZ(), 0.5, 1);  // a flat surface
  }
  EXPECT_EQ(solve(sums).reason, Reason::degenerate);
}

TEST(AlignmentSums, MoveAPoseByAShiftAndATurnAboutTheMiddle) {
  const Pose T{Quaternion(Eigen::AngleAxisd(0.7, Vector3(1, -2, 3).normalized())), {0.4, -0.2, 1}};
  const Vector3 centroid(0.1, 0.3, 0.9), shift(0.01, -0.02, 0.03), turn(0.2, 0.05, -0.1);
  const Pose end = moved(T, {shift, turn}, centroid);
  const Quaternion by(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  for (const Vector3& p : {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(-0.3, 0.5, 2)}) {
    EXPECT_LT((end * p - (by * (T * p - centroid) + centroid + shift)).norm(), 1e-14);
  }
  EXPECT_NEAR(end.rotation.norm(), 1, 1e-15);
  const Pose shifted = moved(T, {shift, Vector3::Zero()}, centroid);
  EXPECT_LT((shifted.translation - T.translation - shift).norm(), 1e-15);
  EXPECT_LT(shifted.rotation.angularDistance(T.rotation), 1e-7);
}

}  // namespace
}  // namespace glint::alignment_sums_test
