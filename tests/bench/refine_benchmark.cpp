// Benchmark of the weighted pose fit from both initial poses, its textbook form, and the rigid fit
// with covariance, on views of the built-in pen in an AHAT camera.
#include <benchmark/benchmark.h>

#include <Eigen/Dense>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/depth_flip.hpp"
#include "kernels/pose/fit_covariance.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/refine_pose.hpp"
#include "kernels/pose/rigid_fit.hpp"
#include "platform/lab/experiments/point_view.hpp"

namespace glint::bench {
namespace {

constexpr std::size_t k_views = 256;

struct View {
  std::vector<WeightedMarker> markers;
  std::vector<Vector3> model, measured;
  std::vector<Matrix3> covariances;
};

std::vector<View> views_of(const PointTool& tool) {
  const Camera camera = ahat_ray_table();
  const ObservationNoise noise{0.1, 0.002};
  std::vector<View> views;
  for (std::uint64_t sample = 0; sample < k_views; ++sample) {
    SampleNumbers numbers(1, 0, sample);
    const Pose pose = draw_pose(tool, 0.5, numbers.within(0, 1), numbers).T_camera_tool;
    PointView points;
    points.clear();
    View view;
    for (int i = 0; i < tool.tool.marker_count; ++i) {
      const Vector3& model = tool.tool.markers_m[static_cast<std::size_t>(i)];
      if (!points.add(camera, tool.tool, pose * model, i, noise, numbers)) continue;
      const auto at = static_cast<std::size_t>(points.markers.count - 1);
      const double range = points.markers.items[at].surface_range_m + tool.tool.centre_offset_m();
      const MarkerMeasurementModel& sight = points.sights[at];
      view.markers.push_back(whiten_marker(model, sight.rays, range, sight.variance).value);
      view.model.push_back(model);
      view.measured.push_back(view.markers.back().measured_m());
      view.covariances.push_back(
          marker_covariance(view.markers.back().ray, noise.range_m, 0.1 * range / 253));
    }
    views.push_back(std::move(view));
  }
  return views;
}

// Textbook Gauss-Newton: the full Jacobian, Eigen's decomposition, ten steps.
Matrix6 textbook_fit(const View& view, const Pose& start, double& chi_square) {
  Pose pose = start;
  Matrix6 normal;
  const auto rows = static_cast<Eigen::Index>(3 * view.markers.size());
  for (int step = 0; step < 10; ++step) {
    Eigen::MatrixXd jacobian(rows, 6);
    Eigen::VectorXd residual(rows);
    Eigen::Index row = 0;
    for (const WeightedMarker& marker : view.markers) {
      const Vector3 point = pose * marker.model_m;
      const double along = marker.ray.dot(point);
      Matrix3 by_point;
      const double first = marker.across_first.dot(point) / along;
      const double second = marker.across_second.dot(point) / along;
      by_point.row(0) = (marker.across_first - marker.ray * first) / along;
      by_point.row(1) = (marker.across_second - marker.ray * second) / along;
      by_point.row(2) = point.normalized() * marker.per_range_sigma;
      jacobian.middleRows<3>(row) = by_point * point_by_pose(pose.rotation * marker.model_m);
      residual.segment<3>(row) =
          Vector3(first, second, (point.norm() - marker.range_m) * marker.per_range_sigma);
      row += 3;
    }
    normal = jacobian.transpose() * jacobian;
    const Vector6 change = -normal.ldlt().solve(jacobian.transpose() * residual);
    pose.translation += change.head<3>();
    pose.rotation = (from_rotation_vector(change.tail<3>()) * pose.rotation).normalized();
    chi_square = residual.squaredNorm();
    if (change.dot(normal * change) < 1e-4) break;
  }
  return normal.inverse();
}

PointTool tool_for(const benchmark::State& state) {
  return state.range(0) == 5 ? five_marker_pen() : ndi_8700339();
}

void refined(benchmark::State& state) {
  const std::vector<View> views = views_of(tool_for(state));
  std::size_t at = 0;
  double steps = 0;
  for (auto _ : state) {
    const RefinedPose pose = refine_pose(views[at++ % k_views].markers, Vector3::Zero());
    steps += pose.work.steps;
    benchmark::DoNotOptimize(pose.chi_square);
  }
  state.counters["steps"] = steps / static_cast<double>(state.iterations());
}

void textbook(benchmark::State& state) {
  const PointTool tool = tool_for(state);
  const std::vector<View> views = views_of(tool);
  const Vector3 mean = marker_mean(tool.tool);
  std::size_t at = 0;
  for (auto _ : state) {
    const View& view = views[at++ % k_views];
    const Pose start = fit_rigid(view.model, view.measured).transform;
    const Pose flip = depth_flipped(start, flattest_direction(view.markers, mean), mean);
    double first = 0, second = 0;
    benchmark::DoNotOptimize(textbook_fit(view, start, first));
    benchmark::DoNotOptimize(textbook_fit(view, flip, second));
    benchmark::DoNotOptimize(first < second);
  }
}

void rigid_with_covariance(benchmark::State& state) {
  const std::vector<View> views = views_of(tool_for(state));
  std::size_t at = 0;
  for (auto _ : state) {
    const View& view = views[at++ % k_views];
    const RigidFit fit = fit_rigid(view.model, view.measured);
    const auto covariance =
        fit_covariance(view.measured, view.covariances, fit.transform.translation);
    benchmark::DoNotOptimize(covariance.value(0, 0));
  }
}

BENCHMARK(refined)->Name("kernel/refine_pose/markers")->Arg(4)->Arg(5);
BENCHMARK(textbook)->Name("rival/refine_pose/textbook")->Arg(4)->Arg(5);
BENCHMARK(rigid_with_covariance)->Name("kernel/fit_rigid/with_covariance")->Arg(4)->Arg(5);

}  // namespace
}  // namespace glint::bench
