// The Point Cloud Library's side of the cloud benchmark: the same steps on one thread.
//
// It is a shared library, loaded at run time. PCL is built with Eigen's vector layout and Glint is
// not; in one program each would call the other's functions.
#include <pcl/ModelCoefficients.h>
#include <pcl/filters/radius_outlier_removal.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/sac_segmentation.h>
#include <pcl/surface/mls.h>

#include "cloud_steps.hpp"
#include "thread_seconds.hpp"

namespace {

using glint::bench::thread_seconds;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

template <class Points>
void give(const Points& cloud, int step, CloudStepResult& result) {
  result.counts[step] = static_cast<int>(cloud.size());
  if (result.points[step] == nullptr) return;
  float* to = result.points[step];
  for (const auto& point : cloud) {
    *to++ = point.x;
    *to++ = point.y;
    *to++ = point.z;
  }
}

}  // namespace

extern "C" __attribute__((visibility("default"))) void glint_bench_pcl(
    const float* xyz, int count, const CloudStepSettings& settings, CloudStepResult& result) {
  auto input = pcl::make_shared<Cloud>();
  input->reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) input->emplace_back(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);

  double begin = thread_seconds();
  const auto lap = [&](int step) {
    const double now = thread_seconds();
    result.seconds[step] = now - begin;
  };
  auto voxels = pcl::make_shared<Cloud>();
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(input);
  grid.setLeafSize(settings.voxel_m, settings.voxel_m, settings.voxel_m);
  grid.filter(*voxels);
  lap(k_step_voxels);
  give(*voxels, k_step_voxels, result);

  begin = thread_seconds();
  auto kept = pcl::make_shared<Cloud>();
  pcl::RadiusOutlierRemoval<pcl::PointXYZ> outliers;
  outliers.setInputCloud(voxels);
  outliers.setRadiusSearch(static_cast<double>(settings.outlier_radius_m));
  outliers.setMinNeighborsInRadius(settings.neighbours_min);
  outliers.filter(*kept);
  lap(k_step_outliers);
  give(*kept, k_step_outliers, result);

  begin = thread_seconds();
  pcl::PointCloud<pcl::PointNormal> smooth;
  pcl::MovingLeastSquares<pcl::PointXYZ, pcl::PointNormal> mls;
  mls.setInputCloud(kept);
  mls.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  mls.setSearchRadius(static_cast<double>(settings.smooth_radius_m));
  mls.setPolynomialOrder(2);
  mls.setComputeNormals(true);
  mls.setNumberOfThreads(1);
  mls.process(smooth);
  lap(k_step_smooth);
  give(smooth, k_step_smooth, result);

  auto flat = pcl::make_shared<Cloud>();
  for (const pcl::PointNormal& point : smooth) flat->emplace_back(point.x, point.y, point.z);
  begin = thread_seconds();
  pcl::SACSegmentation<pcl::PointXYZ> planes;
  planes.setModelType(pcl::SACMODEL_PLANE);
  planes.setMethodType(pcl::SAC_RANSAC);
  planes.setDistanceThreshold(static_cast<double>(settings.plane_threshold_m));
  planes.setOptimizeCoefficients(true);
  planes.setInputCloud(flat);
  pcl::PointIndices on;
  pcl::ModelCoefficients plane;
  planes.segment(on, plane);
  lap(k_step_planes);
  result.counts[k_step_planes] = static_cast<int>(on.indices.size());
}
