// What both sides of the cloud benchmark are told, and what they give back. Plain C, so that the
// rival's library, built with another layout of Eigen's types, meets Glint nowhere else.
#pragma once

extern "C" {

struct CloudStepSettings {
  float voxel_m, outlier_radius_m, smooth_radius_m, plane_threshold_m;
  int neighbours_min;
};

enum { k_step_voxels, k_step_outliers, k_step_smooth, k_step_planes, k_cloud_steps };

// One way through the chain. Points as x, y, z side by side; each step's points go to a buffer for
// as many as came in, if one is given.
struct CloudStepResult {
  double seconds[k_cloud_steps];
  int counts[k_cloud_steps];  // points after each step; of the last: on the largest plane
  float* points[k_cloud_steps - 1];
};

using RunCloudSteps = void (*)(const float* xyz, int count, const CloudStepSettings& settings,
                               CloudStepResult& result);
}
