// Input and output of both sides of the cloud benchmark. It is plain C, as the PCL library is built
// with another layout of Eigen's types.
#pragma once

extern "C" {

struct CloudStepSettings {
  float voxel_m, outlier_radius_m, smooth_radius_m, plane_threshold_m;
  int neighbours_min;
};

enum { k_step_voxels, k_step_outliers, k_step_smooth, k_step_planes, k_cloud_steps };

// One run of the chain. Points are interleaved x, y, z. Each step writes its points to its buffer,
// if any; a buffer has the capacity of the input.
struct CloudStepResult {
  double seconds[k_cloud_steps];
  int counts[k_cloud_steps];  // points after each step; the last: points on the largest plane
  float* points[k_cloud_steps - 1];
};

using RunCloudSteps = void (*)(const float* xyz, int count, const CloudStepSettings& settings,
                               CloudStepResult& result);
}
