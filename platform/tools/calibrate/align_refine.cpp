#include "platform/tools/calibrate/align_refine.hpp"

#include <ceres/ceres.h>

#include "platform/dense.hpp"
#include "platform/tools/calibrate/pose_block.hpp"
#include "platform/tools/calibrate/robust.hpp"

namespace glint {
namespace {

constexpr int k_alignment_iterations_max = 100;
// Relative to the information scaled to a unit diagonal; a smaller eigenvalue means undetermined.
constexpr double k_eigenvalue_min = 1e-10;
constexpr std::size_t k_block_residuals = 6 * 5;  // five samples' noise may be correlated

struct AlignCost {
  AlignSample sample;

  template <class Scalar>
  bool operator()(const Scalar* x, const Scalar* y, const Scalar* offset, Scalar* residual) const {
    const PoseOf<Scalar> pose_x{QuaternionOf<Scalar>(x), Vector3Of<Scalar>(x[4], x[5], x[6])};
    const PoseOf<Scalar> pose_y{QuaternionOf<Scalar>(y), Vector3Of<Scalar>(y[4], y[5], y[6])};
    const AlignResidual<Scalar> found = align_residual<Scalar>(sample, pose_x, pose_y, offset[0]);
    for (int axis = 0; axis < 3; ++axis) {
      residual[axis] = found.position[axis];
      residual[axis + 3] = found.rotation[axis];
    }
    return true;
  }
};

using Matrix13 = Eigen::Matrix<double, 13, 13>;

// J^T J in tangents, and the sum of outer products of the scores of blocks of samples, which
// accounts for correlated and unequal noise.
struct Information {
  Matrix13 jacobians = Matrix13::Zero();
  Matrix13 scores = Matrix13::Zero();
};

Information information_of(ceres::Problem& problem,
                           const ceres::Problem::EvaluateOptions& options) {
  std::vector<double> residuals;
  ceres::CRSMatrix rows;
  problem.Evaluate(options, nullptr, &residuals, nullptr, &rows);
  using Row = Eigen::Matrix<double, 1, 13>;
  Row scale = Row::Ones();
  scale.segment<3>(0).setConstant(0.5);  // a quaternion's tangent is half an angle
  scale.segment<3>(6).setConstant(0.5);
  Information information;
  Row score = Row::Zero();
  for (std::size_t row = 0; row < residuals.size(); ++row) {
    Row line = Row::Zero();
    for (int i = rows.rows[row]; i < rows.rows[row + 1]; ++i) {
      const auto at = static_cast<std::size_t>(i);
      line[rows.cols[at]] += rows.values[at] * scale[rows.cols[at]];
    }
    information.jacobians += line.transpose() * line;
    score += residuals[row] * line;
    if ((row + 1) % k_block_residuals != 0 && row + 1 < residuals.size()) continue;
    information.scores += score.transpose() * score;
    score.setZero();
  }
  return information;
}

// J^-1 S J^-1 over the free unknowns.
// Source: Liang and Zeger 1986, Biometrika 73(1), the robust covariance of theorem 1.
void invert(const Information& information, LeverArm lever_arm, AlignFit& fit) {
  std::vector<Eigen::Index> free{0, 1, 2, 3, 4, 5, 12};
  if (lever_arm == LeverArm::unknown) free = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const Eigen::MatrixXd part = information.jacobians(free, free);
  const Eigen::VectorXd unit = part.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = unit.asDiagonal() * part * unit.asDiagonal();
  fit.determined = symmetric_eigen(scaled).values[0] > k_eigenvalue_min;
  if (!fit.determined) return;
  const Eigen::MatrixXd inverse = unit.asDiagonal() * inverse_of(scaled) * unit.asDiagonal();
  const Eigen::MatrixXd left = inverse.lazyProduct(information.scores(free, free));
  const Eigen::MatrixXd covariance = left.lazyProduct(inverse);
  for (std::size_t i = 0; i < free.size(); ++i)
    for (std::size_t j = 0; j < free.size(); ++j)
      fit.covariance(free[i], free[j]) =
          covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
}

}  // namespace

AlignFit refined_alignment(std::span<const AlignSample> samples, const AlignGuess& start,
                           LeverArm lever_arm, AlignLoss loss) {
  PoseBlock x = block_of(start.x), y = block_of(start.y);
  double offset = start.offset_s;
  ceres::Problem problem;
  for (const AlignSample& sample : samples) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<AlignCost, 6, 7, 7, 1>(new AlignCost{sample}),
        loss == AlignLoss::cauchy ? new ceres::CauchyLoss(k_cauchy_sigmas) : nullptr, x.data(),
        y.data(), &offset);
  }
  problem.SetManifold(x.data(), new PoseManifold);
  problem.SetManifold(y.data(), new PoseManifold);
  if (lever_arm == LeverArm::none) problem.SetParameterBlockConstant(y.data());

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = k_alignment_iterations_max;
  solver.function_tolerance = 1e-12;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);

  AlignFit fit{start, Matrix13::Zero(), false};
  if (!summary.IsSolutionUsable()) return fit;
  fit.found = {pose_of(x), pose_of(y), offset};
  if (lever_arm == LeverArm::none) problem.SetParameterBlockVariable(y.data());
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = {x.data(), y.data(), &offset};
  options.apply_loss_function = false;
  invert(information_of(problem, options), lever_arm, fit);
  return fit;
}

}  // namespace glint
