// Accuracy of smoothed point clouds of simulated surfaces.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "kernels/cloud/moving_least_squares.hpp"
#include "kernels/cloud/voxel_grid.hpp"
#include "kernels/geometry.hpp"

namespace glint {
namespace {

constexpr double k_points_per_m2 = 2e5;  // long throw at 1 m: ten frames, 6 mm a pixel
constexpr double k_rms_ratio_max = 0.30;
constexpr double k_bias_max_m = 0.0006;

struct Surface {
  std::string name;
  double area_m2;
  std::function<Vector3(double, double)> at;       // area-uniform map of two numbers from 0 to 1
  std::function<Vector3(const Vector3&)> outward;  // unit normal
  std::function<double(const Vector3&)> height;    // signed distance from the surface
  std::function<bool(const Vector3&)> is_inside;   // at least a radius inside the surface's rim
};

std::vector<Surface> surfaces() {
  const auto around_z = [](const Vector3& p) { return Vector3(p.x(), p.y(), 0); };
  return {
      {"plane", 0.36, [](double s, double t) { return Vector3(0.6 * s - 0.3, 0.6 * t - 0.3, 0); },
       [](const Vector3&) { return Vector3(Vector3::UnitZ()); },
       [](const Vector3& p) { return p.z(); },
       [](const Vector3& p) { return std::abs(p.x()) < 0.27 && std::abs(p.y()) < 0.27; }},
      {"sphere of 10 cm", 4 * std::numbers::pi * 0.01,
       [](double s, double t) {
         const double z = 2 * s - 1, r = std::sqrt(1 - z * z), angle = 2 * std::numbers::pi * t;
         return Vector3(0.1 * r * std::cos(angle), 0.1 * r * std::sin(angle), 0.1 * z);
       },
       [](const Vector3& p) { return Vector3(p.normalized()); },
       [](const Vector3& p) { return p.norm() - 0.1; }, [](const Vector3&) { return true; }},
      {"cylinder of 5 cm", 2 * std::numbers::pi * 0.05 * 0.6,
       [](double s, double t) {
         const double angle = 2 * std::numbers::pi * t;
         return Vector3(0.05 * std::cos(angle), 0.05 * std::sin(angle), 0.6 * s - 0.3);
       },
       [around_z](const Vector3& p) { return Vector3(around_z(p).normalized()); },
       [around_z](const Vector3& p) { return around_z(p).norm() - 0.05; },
       [](const Vector3& p) { return std::abs(p.z()) < 0.27; }}};
}

struct Errors {
  double rms_m = 0, bias_m = 0;
  int n = 0;
};

Errors errors_of(const PointCloud& cloud, const Surface& surface) {
  Errors out;
  for (int i = 0; i < cloud.count; ++i) {
    const Vector3 point(static_cast<double>(cloud.x[i]), static_cast<double>(cloud.y[i]),
                        static_cast<double>(cloud.z[i]));
    if (!surface.is_inside(point)) continue;
    const double height = surface.height(point);
    out.rms_m += height * height;
    out.bias_m += height;
    ++out.n;
  }
  out.rms_m = std::sqrt(out.rms_m / out.n);
  out.bias_m /= out.n;
  return out;
}

TEST(SmoothingAccuracy, LeavesThreeTenthsOfTheNoiseAndNoBiasOnPlaneSphereAndCylinder) {
  constexpr int capacity = 200'000;
  constexpr MovingLeastSquaresSettings settings;
  std::vector<std::byte> memory(3 * PointCloud::bytes(capacity) + VoxelGrid::bytes(capacity) +
                                MovingLeastSquares::bytes(settings, capacity) + Arena::k_alignment);
  Arena arena(memory);
  PointCloud raw, voxels, smoothed;
  VoxelGrid grid;
  MovingLeastSquares smoothing;
  for (PointCloud* cloud : {&raw, &voxels, &smoothed}) {
    ASSERT_EQ(cloud->prepare(capacity, arena), Reason::none);
  }
  ASSERT_EQ(grid.prepare({}, capacity, arena), Reason::none);
  ASSERT_EQ(smoothing.prepare(settings, capacity, arena), Reason::none);
  for (const Surface& surface : surfaces()) {
    for (const double noise_m : {0.002, 0.004}) {
      std::mt19937_64 random(1);
      std::uniform_real_distribution<double> place(0, 1);
      std::normal_distribution<double> noise(0, noise_m);
      raw.count = voxels.count = smoothed.count = 0;
      for (int i = 0; i < static_cast<int>(k_points_per_m2 * surface.area_m2); ++i) {
        const double s = place(random), t = place(random);
        const Vector3 on = surface.at(s, t);
        const Vector3 point = on + noise(random) * surface.outward(on);
        ASSERT_TRUE(raw.add(static_cast<float>(point.x()), static_cast<float>(point.y()),
                            static_cast<float>(point.z())));
      }
      grid.clear();
      grid.add(raw, 0, raw.count);
      grid.write(0, grid.count(), voxels);
      smoothing.begin(voxels);
      while (!smoothing.step(10'000, smoothed)) {
      }
      const Errors before = errors_of(voxels, surface), after = errors_of(smoothed, surface);
      std::printf(
          "%-18s %g mm noise: %6d voxels %.3f mm rms, smoothed %.3f mm (%.3f), bias %+.3f\n",
          surface.name.c_str(), 1e3 * noise_m, before.n, 1e3 * before.rms_m, 1e3 * after.rms_m,
          after.rms_m / before.rms_m, 1e3 * after.bias_m);
      EXPECT_GT(after.n, 2'000);
      EXPECT_LE(after.rms_m, k_rms_ratio_max * before.rms_m) << surface.name << noise_m;
      EXPECT_LE(std::abs(after.bias_m), k_bias_max_m) << surface.name << noise_m;
    }
  }
}

}  // namespace
}  // namespace glint
