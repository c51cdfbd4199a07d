#include <ceres/ceres.h>

#include "kernels/calibrate/marker_residual.hpp"
#include "platform/tools/calibrate/bundle.hpp"
#include "platform/tools/calibrate/pose_block.hpp"
#include "platform/tools/calibrate/robust.hpp"

namespace glint {
namespace {

constexpr int k_bundle_iterations_max = 100;
constexpr double k_unit_m = 1e-3;  // scales residuals to millimetres: near one

struct MarkerCost {
  Vector3 measured_m;

  template <class Scalar>
  bool operator()(const Scalar* pose, const Scalar* marker, Scalar* residual) const {
    const Vector3Of<Scalar> miss =
        marker_residual<Scalar>(measured_m, k_unit_m, QuaternionOf<Scalar>(pose),
                                Vector3Of<Scalar>(pose[4], pose[5], pose[6]),
                                Vector3Of<Scalar>(marker[0], marker[1], marker[2]));
    for (int axis = 0; axis < 3; ++axis) residual[axis] = miss[axis];
    return true;
  }
};

}  // namespace

Bundle refined_bundle(Bundle start, std::span<const LabelledPoint> points, double sigma_m) {
  Bundle bundle = start;
  std::vector<PoseBlock> poses;
  for (const Pose& pose : bundle.poses) poses.push_back(block_of(pose));

  PoseManifold manifold;  // shared by all poses
  ceres::Problem::Options options;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(options);
  auto* order = new ceres::ParameterBlockOrdering;
  for (const LabelledPoint& point : points) {
    double* pose = poses[point.frame].data();
    double* marker = bundle.markers_m[point.marker].data();
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<MarkerCost, 3, 7, 3>(new MarkerCost{point.measured_m}),
        sigma_m > 0 ? new ceres::CauchyLoss(k_cauchy_sigmas * sigma_m / k_unit_m) : nullptr, pose,
        marker);
    problem.SetManifold(pose, &manifold);
    order->AddElementToGroup(pose, 0);
    order->AddElementToGroup(marker, 1);
  }
  // Fixes the gauge (tool frame against poses): the first pose is constant.
  problem.SetParameterBlockConstant(poses[points.front().frame].data());

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.linear_solver_ordering.reset(order);
  solver.max_num_iterations = k_bundle_iterations_max;
  solver.function_tolerance = 1e-10;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (!summary.IsSolutionUsable()) return start;
  for (std::size_t i = 0; i < poses.size(); ++i) bundle.poses[i] = pose_of(poses[i]);
  return bundle;
}

}  // namespace glint
