// The Point Cloud Library's side of the alignment benchmark: iterative closest point on one thread
// with default termination, ten iterations; more are slower and more accurate.
#include <pcl/registration/icp.h>

#include "alignment_steps.hpp"
#include "thread_seconds.hpp"

namespace {

using glint::bench::thread_seconds;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

Cloud::Ptr cloud_of(const float* xyz, int count) {
  auto cloud = pcl::make_shared<Cloud>();
  cloud->reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) cloud->emplace_back(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
  return cloud;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) void glint_bench_pcl_alignment(
    const AlignmentTask& task, AlignmentAnswer& answer) {
  const Cloud::Ptr source = cloud_of(task.source, task.source_count);
  const Cloud::Ptr target = cloud_of(task.target, task.target_count);
  const double begin = thread_seconds();
  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
  icp.setInputSource(source);
  icp.setInputTarget(target);
  icp.setMaxCorrespondenceDistance(static_cast<double>(task.reach_m));
  Cloud moved;
  icp.align(moved);
  answer.seconds = thread_seconds() - begin;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c)
      answer.matrix[4 * r + c] = static_cast<double>(icp.getFinalTransformation()(r, c));
  }
}
