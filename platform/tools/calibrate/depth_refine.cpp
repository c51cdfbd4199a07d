#include "platform/tools/calibrate/depth_refine.hpp"

#include <ceres/ceres.h>

#include <memory>

#include "platform/dense.hpp"
#include "platform/tools/calibrate/correlation.hpp"
#include "platform/tools/calibrate/pose_block.hpp"
#include "platform/tools/calibrate/robust.hpp"

namespace glint {
namespace {

constexpr int k_depth_iterations_max = 50;
constexpr double k_bias_eigenvalue_min = 1e-10;  // of the information scaled to a diagonal of one

struct DepthCost {
  DepthSample sample;

  template <class Scalar>
  bool operator()(const Scalar* pose, const Scalar* bias, Scalar* residual) const {
    const Vector3Of<Scalar> found = depth_residual<Scalar>(
        sample, QuaternionOf<Scalar>(pose), Vector3Of<Scalar>(pose[4], pose[5], pose[6]),
        Vector3Of<Scalar>(bias[0], bias[1], bias[2]));
    for (int i = 0; i < 3; ++i) residual[i] = found[i];
    return true;
  }
};

using PoseRows = Eigen::Matrix<double, Eigen::Dynamic, 6>;
using BiasRows = Eigen::Matrix<double, Eigen::Dynamic, 3>;

// Residuals of one frame, and their derivatives by its pose (in tangents) and by the bias.
struct FrameRows {
  PoseRows by_pose;
  BiasRows by_bias;
  Eigen::VectorXd residuals;
};

FrameRows rows_of(const RangedFrame& frame, const Vector3& bias) {
  const PoseManifold manifold;
  const PoseBlock pose = block_of(frame.T_camera_tool);
  Eigen::Matrix<double, 7, 6, Eigen::RowMajor> tangent;
  manifold.PlusJacobian(pose.data(), tangent.data());
  const auto count = static_cast<Eigen::Index>(3 * frame.samples.size());
  FrameRows rows{PoseRows::Zero(count, 6), BiasRows::Zero(count, 3), Eigen::VectorXd::Zero(count)};
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < frame.samples.size(); ++i) {
    if (!frame.kept[i]) continue;
    const ceres::AutoDiffCostFunction<DepthCost, 3, 7, 3> cost(new DepthCost{frame.samples[i]});
    Eigen::Matrix<double, 3, 7, Eigen::RowMajor> by_pose;
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> by_bias;
    const double* blocks[] = {pose.data(), bias.data()};
    double* jacobians[] = {by_pose.data(), by_bias.data()};
    Vector3 residual;
    cost.Evaluate(blocks, residual.data(), jacobians);
    rows.by_pose.middleRows<3>(at) = by_pose * tangent;
    rows.by_bias.middleRows<3>(at) = by_bias;
    rows.residuals.segment<3>(at) = residual;
    at += 3;
  }
  rows.by_pose.conservativeResize(at, 6);
  rows.by_bias.conservativeResize(at, 3);
  rows.residuals.conservativeResize(at);
  return rows;
}

// Eliminates the poses frame by frame (Schur complement). Separates the noise of pixels and ranges
// by the redundancy of each residual within its frame.
// Source: Foerstner and Wrobel 2016, Photogrammetric Computer Vision, eq. (4.99), (4.60).
void estimate_covariance(const std::vector<RangedFrame>& frames, Brightness brightness,
                         DepthFit& fit) {
  Matrix3 information = Matrix3::Zero();
  std::vector<Vector3> scores;
  double squares[2] = {0, 0}, redundancy[2] = {0, 0};  // of pixels, of ranges
  for (const RangedFrame& frame : frames) {
    const FrameRows rows = rows_of(frame, fit.bias);
    if (rows.residuals.size() < 9) continue;  // fewer than three markers
    const Eigen::MatrixXd pose_part =         // 6 x rows
        solve_symmetric(rows.by_pose.transpose() * rows.by_pose, rows.by_pose.transpose());
    const BiasRows free = rows.by_bias - rows.by_pose * (pose_part * rows.by_bias);
    information += free.transpose() * free;
    scores.push_back(free.transpose() * rows.residuals);
    for (Eigen::Index i = 0; i < rows.residuals.size(); ++i) {
      const int kind = i % 3 == 2 ? 1 : 0;
      squares[kind] += rows.residuals[i] * rows.residuals[i];
      redundancy[kind] += 1 - rows.by_pose.row(i).dot(pose_part.col(i));
    }
  }
  if (brightness == Brightness::left_out) information(2, 2) = 1;  // decouples the unused unknown
  fit.pixel_variance = squares[0] / std::max(redundancy[0], 1.0);
  fit.range_variance = squares[1] / std::max(redundancy[1], 1.0);
  const Vector3 unit = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Matrix3 scaled = unit.asDiagonal() * information * unit.asDiagonal();
  fit.determined = symmetric_eigen(scaled).values[0] > k_bias_eigenvalue_min;
  if (!fit.determined) return;
  const Matrix3 root = inverse_root_of(scaled);
  for (Vector3& score : scores) score = root * (unit.asDiagonal() * score);
  fit.variance_inflation = correlation_factor(scores);
  fit.covariance =
      fit.variance_inflation * (unit.asDiagonal() * scaled.inverse() * unit.asDiagonal());
  if (brightness == Brightness::left_out) {
    fit.covariance.row(2).setZero();
    fit.covariance.col(2).setZero();
  }
}

}  // namespace

DepthFit refined_depth(std::vector<RangedFrame>& frames, const Vector3& start,
                       Brightness brightness, DepthLoss loss) {
  DepthFit fit;
  Vector3 bias = start;
  std::vector<PoseBlock> poses;
  for (const RangedFrame& frame : frames) poses.push_back(block_of(frame.T_camera_tool));

  PoseManifold moved;  // shared by all poses
  ceres::SubsetManifold without_dim(3, {2});
  ceres::CauchyLoss cauchy(k_cauchy_sigmas);
  ceres::Problem::Options options;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(options);
  auto* order = new ceres::ParameterBlockOrdering;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    bool used = false;
    for (std::size_t i = 0; i < frames[f].samples.size(); ++i) {
      if (!frames[f].kept[i]) continue;
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<DepthCost, 3, 7, 3>(new DepthCost{frames[f].samples[i]}),
          loss == DepthLoss::cauchy ? &cauchy : nullptr, poses[f].data(), bias.data());
      used = true;
    }
    if (!used) continue;
    problem.SetManifold(poses[f].data(), &moved);
    order->AddElementToGroup(poses[f].data(), 0);
  }
  order->AddElementToGroup(bias.data(), 1);
  if (brightness == Brightness::left_out) problem.SetManifold(bias.data(), &without_dim);

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.linear_solver_ordering.reset(order);
  solver.max_num_iterations = k_depth_iterations_max;
  solver.function_tolerance = 1e-12;
  solver.parameter_tolerance = 1e-12;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (!summary.IsSolutionUsable()) return fit;
  fit.bias = bias;
  for (std::size_t f = 0; f < frames.size(); ++f) frames[f].T_camera_tool = pose_of(poses[f]);
  estimate_covariance(frames, brightness, fit);
  return fit;
}

}  // namespace glint
