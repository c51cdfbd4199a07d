#include "platform/tools/calibrate/pivot_refine.hpp"

#include <ceres/ceres.h>

#include <vector>

#include "platform/tools/calibrate/robust.hpp"

namespace glint {
namespace {

constexpr int k_pivot_iterations_max = 50;

struct PivotCost {
  PivotSample sample;

  template <class Scalar>
  bool operator()(const Scalar* rotation, const Scalar* lever, const Scalar* post,
                  Scalar* residual) const {
    const PivotResidual<Scalar> found = pivot_residual<Scalar>(
        sample, QuaternionOf<Scalar>(rotation), Vector3Of<Scalar>(lever[0], lever[1], lever[2]),
        Vector3Of<Scalar>(post[0], post[1], post[2]));
    for (int axis = 0; axis < 3; ++axis) {
      residual[axis] = found.position[axis];
      residual[axis + 3] = found.rotation[axis];
    }
    return true;
  }
};

}  // namespace

PivotPoint refined_pivot(std::span<const PivotSample> samples, const PivotPoint& start,
                         PivotLoss loss) {
  PivotPoint point = start;
  std::vector<Quaternion> rotations;
  for (const PivotSample& sample : samples) rotations.push_back(sample.rotation);

  ceres::EigenQuaternionManifold unit;  // shared by all rotations
  ceres::Problem::Options options;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(options);
  auto* order = new ceres::ParameterBlockOrdering;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    double* rotation = rotations[i].coeffs().data();
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<PivotCost, 6, 4, 3, 3>(new PivotCost{samples[i]}),
        loss == PivotLoss::cauchy ? new ceres::CauchyLoss(k_cauchy_sigmas) : nullptr, rotation,
        point.lever_m.data(), point.post_m.data());
    problem.SetManifold(rotation, &unit);
    order->AddElementToGroup(rotation, 0);
  }
  order->AddElementToGroup(point.lever_m.data(), 1);
  order->AddElementToGroup(point.post_m.data(), 1);

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.linear_solver_ordering.reset(order);
  solver.max_num_iterations = k_pivot_iterations_max;
  solver.function_tolerance = 1e-12;
  solver.parameter_tolerance = 1e-12;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  return summary.IsSolutionUsable() ? point : start;
}

}  // namespace glint
