#include "platform/tools/calibrate/lens_fit.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/calibrate/lens_residual.hpp"
#include "platform/formats/npy.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/calibrate/figure_text.hpp"

namespace glint {
namespace {

constexpr int k_lens_iterations_max = 200;
constexpr std::size_t k_fitted_max = 20'000;  // rays in the fit; the errors cover all rays
constexpr std::size_t k_rays_min = 1'000;
constexpr double k_pinhole_tangent = 0.36;  // 20 degrees: limit of the pinhole initial guess

using Lens12 = std::array<double, k_lens_numbers>;

struct RaySample {
  Vector2 plane;  // on z = 1
  Vector2 pixel;
};

struct LensCost {
  RaySample ray;

  template <class Scalar>
  bool operator()(const Scalar* lens, Scalar* residual) const {
    const Vector2Of<Scalar> miss = lens_residual<Scalar>(ray.plane, ray.pixel, lens);
    residual[0] = miss.x();
    residual[1] = miss.y();
    return true;
  }
};

struct Grid {
  int width = 0, height = 0;
  std::vector<RaySample> rays;
};

Grid grid_of(const std::string& path, int width) {
  const NpyArray array = read_npy_float32(path);
  const auto count = array.values.size() / 3;
  Grid grid;
  const bool flat = array.shape.size() == 2 && array.shape[1] == 3;
  if (array.shape.size() == 3 && array.shape[2] == 3) {
    grid.width = static_cast<int>(array.shape[1]);
  } else if (flat) {
    grid.width =
        width > 0 ? width : static_cast<int>(std::lround(std::sqrt(static_cast<double>(count))));
  }
  const auto columns = static_cast<std::size_t>(grid.width);
  if (columns == 0 || count % columns != 0) {
    throw InputError(path + ": " + std::to_string(count) + " rays do not fill rows of " +
                     std::to_string(grid.width) +
                     "; expected height x width x 3, or rows x 3 and the image's --width");
  }
  grid.height = static_cast<int>(count / columns);
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3 ray(array.values[3 * i], array.values[3 * i + 1], array.values[3 * i + 2]);
    if (ray.z() == 0) continue;  // no ray at this pixel
    if (!(std::abs(ray.norm() - 1) < 1e-3 && ray.z() > 0)) {
      throw InputError(path + ":row " + std::to_string(i) +
                       ": not a unit vector with z above 0; expected unit rays, or zeros");
    }
    grid.rays.push_back(
        {ray.head<2>() / ray.z(),
         {static_cast<double>(i % columns) + 0.5, static_cast<double>(i / columns) + 0.5}});
  }
  if (grid.rays.size() >= k_rays_min) return grid;
  throw InputError(path + ": " + std::to_string(grid.rays.size()) + " rays; expected at least " +
                   std::to_string(k_rays_min));
}

// Pinhole parameters by linear regression of pixel on ray slope, over the rays near the axis.
Lens12 pinhole(const std::vector<RaySample>& rays) {
  Eigen::Vector2d slope, middle;
  for (int axis = 0; axis < 2; ++axis) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const RaySample& ray : rays) {
      if (ray.plane.norm() > k_pinhole_tangent) continue;
      const double a = ray.plane[axis], b = ray.pixel[axis];
      n += 1;
      x += a;
      y += b;
      xx += a * a;
      xy += a * b;
    }
    slope[axis] = (n * xy - x * y) / (n * xx - x * x);
    middle[axis] = (y - slope[axis] * x) / n;
  }
  return {slope.x(), slope.y(), middle.x(), middle.y(), 0, 0, 0, 0, 0, 0, 0, 0};
}

Lens12 fitted(const std::vector<RaySample>& rays, Lens12 lens) {
  ceres::Problem problem;
  const std::size_t step = rays.size() / k_fitted_max + 1;
  for (std::size_t i = 0; i < rays.size(); i += step) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<LensCost, 2, k_lens_numbers>(new LensCost{rays[i]}),
        nullptr, lens.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = k_lens_iterations_max;
  options.function_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return lens;
}

}  // namespace

LensFit fit_lens_to_table(const std::string& npy_path, int width) {
  const Grid grid = grid_of(npy_path, width);
  const Lens12 start = pinhole(grid.rays);
  if (!std::isfinite(start[0] + start[1] + start[2] + start[3])) {
    throw InputError(npy_path + ": no rays within 20 degrees of the axis; expected z along the " +
                     "image's centre");
  }
  const Lens12 lens = fitted(grid.rays, start);

  LensFit fit;
  fit.model.lens = Lens::rational;
  fit.model.width = grid.width;
  fit.model.height = grid.height;
  fit.model.fx = lens[0];
  fit.model.fy = lens[1];
  fit.model.cx = lens[2];
  fit.model.cy = lens[3];
  std::copy(lens.begin() + 4, lens.end(), fit.model.distortion.begin());
  std::vector<double> squares(90, 0), counts(90, 0);
  double sum = 0;
  for (const RaySample& ray : grid.rays) {
    const Vector2 miss = lens_residual<double>(ray.plane, ray.pixel, lens.data());
    const double tangent = ray.plane.norm();
    fit.model.field_tangent_max = std::max(fit.model.field_tangent_max, tangent);
    const auto degree = static_cast<std::size_t>(std::atan(tangent) * k_degrees_per_radian);
    squares[degree] += miss.squaredNorm();
    ++counts[degree];
    sum += miss.squaredNorm();
    fit.error_max_px = std::max(fit.error_max_px, miss.norm());
  }
  fit.pixels = static_cast<int>(grid.rays.size());
  fit.rms_px = std::sqrt(sum / (2.0 * fit.pixels));
  for (std::size_t i = 0; i < counts.size() && counts[i] > 0; ++i) {
    fit.error_by_angle_px.push_back(std::sqrt(squares[i] / counts[i]));
  }
  return fit;
}

}  // namespace glint
