#include "platform/tools/calibrate/spin_refine.hpp"

#include <ceres/ceres.h>

#include "kernels/calibrate/axis_residual.hpp"
#include "platform/tools/calibrate/robust.hpp"

namespace glint {
namespace {

constexpr int k_spin_iterations_max = 50;

struct AxisCost {
  Quaternion rotation;

  template <class Scalar>
  bool operator()(const Scalar* tool, const Scalar* tracker, Scalar* residual) const {
    const Vector3Of<Scalar> miss =
        axis_residual<Scalar>(rotation, Vector3Of<Scalar>(tool[0], tool[1], tool[2]),
                              Vector3Of<Scalar>(tracker[0], tracker[1], tracker[2]));
    for (int axis = 0; axis < 3; ++axis) residual[axis] = miss[axis];
    return true;
  }
};

}  // namespace

SpinAxis refined_axis(std::span<const Quaternion> rotations, const SpinAxis& start,
                      double sigma_rad) {
  SpinAxis axis = start;
  ceres::Problem problem;
  for (const Quaternion& rotation : rotations) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<AxisCost, 3, 3, 3>(new AxisCost{rotation}),
        sigma_rad > 0 ? new ceres::CauchyLoss(k_cauchy_sigmas * sigma_rad) : nullptr,
        axis.tool.data(), axis.tracker.data());
  }
  problem.SetManifold(axis.tool.data(), new ceres::SphereManifold<3>);
  problem.SetManifold(axis.tracker.data(), new ceres::SphereManifold<3>);
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = k_spin_iterations_max;
  solver.function_tolerance = 1e-14;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  return summary.IsSolutionUsable() ? axis : start;
}

}  // namespace glint
