// Settings of the mapping chain, in the order of its stages.
#pragma once

#include "kernels/cloud/depth_points.hpp"
#include "kernels/cloud/moving_least_squares.hpp"
#include "kernels/cloud/plane_support.hpp"
#include "kernels/cloud/planes.hpp"
#include "kernels/cloud/radius_outlier.hpp"
#include "kernels/cloud/voxel_grid.hpp"

namespace glint {

struct MapSettings {
  DepthPointSettings depth;
  VoxelGridSettings voxels;
  RadiusOutlierSettings outliers;
  MovingLeastSquaresSettings smoothing;
  PlaneSettings planes;
  PlaneSupportSettings support;
  int voxels_max = 1 << 20;
};

}  // namespace glint
