#include "cloud_glint.hpp"

#include <cstdio>
#include <cstdlib>
#include <vector>

#include "kernels/cloud/moving_least_squares.hpp"
#include "kernels/cloud/planes.hpp"
#include "kernels/cloud/radius_outlier.hpp"
#include "kernels/cloud/snap_to_planes.hpp"
#include "kernels/cloud/voxel_grid.hpp"
#include "thread_seconds.hpp"

namespace glint::bench {
namespace {

constexpr int k_slice = 4096;  // slice of a background group

void give(const PointCloud& cloud, int step, CloudStepResult& result) {
  result.counts[step] = cloud.count;
  float* to = result.points[step];
  for (int i = 0; to != nullptr && i < cloud.count; ++i) {
    *to++ = cloud.x[i];
    *to++ = cloud.y[i];
    *to++ = cloud.z[i];
  }
}

void check(Reason reason) {
  if (reason == Reason::none) return;
  std::fprintf(stderr, "bench_cloud: %.*s\n", static_cast<int>(name_of(reason).size()),
               name_of(reason).data());
  std::exit(1);
}

}  // namespace

struct CloudChain::Kernels {
  std::vector<std::byte> memory;
  PointCloud input, voxel_points, kept, smoothed;
  VoxelGrid voxels;
  RadiusOutlier outliers;
  MovingLeastSquares smoothing;
  PlaneSearch planes;
  PlaneSupport support;
};

CloudChain::CloudChain(const CloudStepSettings& s, int points)
    : kernels_(std::make_unique<Kernels>()) {
  Kernels& k = *kernels_;
  MovingLeastSquaresSettings smooth;
  smooth.radius_m = s.smooth_radius_m;
  smooth.weights = NeighbourWeights::equal;  // PCL's weights
  PlaneSettings plane;
  plane.gate.threshold_m = s.plane_threshold_m;
  plane.planes_max = 1;
  RadiusOutlierSettings outlier;
  outlier.radius_m = s.outlier_radius_m;
  outlier.neighbours_min = s.neighbours_min;
  k.memory.resize(4 * PointCloud::bytes(points) + VoxelGrid::bytes(points) +
                  RadiusOutlier::bytes(points) + MovingLeastSquares::bytes(smooth, points) +
                  PlaneSearch::bytes(points) + PlaneSupport::bytes(points) + Arena::k_alignment);
  Arena arena(k.memory);
  for (PointCloud* cloud : {&k.input, &k.voxel_points, &k.kept, &k.smoothed}) {
    check(cloud->prepare(points, arena));
  }
  check(k.voxels.prepare({s.voxel_m}, points, arena));
  check(k.outliers.prepare(outlier, points, arena));
  check(k.smoothing.prepare(smooth, points, arena));
  check(k.planes.prepare(plane, points, arena));
  check(k.support.prepare({}, points, arena));
}

CloudChain::~CloudChain() = default;

const PointCloud& CloudChain::smoothed() const { return kernels_->smoothed; }

void CloudChain::run(const float* xyz, int count, CloudStepResult& result) {
  Kernels& k = *kernels_;
  k.input.count = 0;
  for (int i = 0; i < count; ++i) {
    (void)k.input.add(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
  }
  double begin = thread_seconds();
  const auto lap = [&](int step, Reason reason) {
    result.seconds[step] = thread_seconds() - begin;
    check(reason);
  };
  k.voxels.clear();
  k.voxel_points.count = 0;
  for (int at = 0; at < count;) at = k.voxels.add(k.input, at, k_slice);
  for (int at = 0; at < k.voxels.count();) at = k.voxels.write(at, k_slice, k.voxel_points);
  lap(k_step_voxels, k.voxels.reason());
  give(k.voxel_points, k_step_voxels, result);

  begin = thread_seconds();
  k.kept.count = 0;
  k.outliers.begin(k.voxel_points);
  while (!k.outliers.step(k_slice, k.kept)) {
  }
  lap(k_step_outliers, k.outliers.reason());
  give(k.kept, k_step_outliers, result);

  begin = thread_seconds();
  k.smoothed.count = 0;
  k.smoothing.begin(k.kept);
  while (!k.smoothing.step(k_slice, k.smoothed)) {
  }
  lap(k_step_smooth, k.smoothing.reason());
  give(k.smoothed, k_step_smooth, result);

  begin = thread_seconds();
  k.planes.begin(k.smoothed);
  while (!k.planes.step(k_slice)) {
  }
  k.support.begin(k.smoothed, k.planes);
  while (!k.support.step(k_slice)) {
  }
  for (int at = 0; at < k.smoothed.count;)
    at = snap_to_planes(k.planes, k.support, at, k_slice, k.smoothed);
  lap(k_step_planes, k.planes.reason());
  result.counts[k_step_planes] = k.planes.count() > 0 ? k.planes.plane(0).points : 0;
}

}  // namespace glint::bench
