#include "platform/budget/inputs/pose_kernels.hpp"

namespace glint {

void add_pose_kernels(std::vector<std::unique_ptr<MeasuredKernel>>& kernels) {
  kernels.push_back(inputs::stamp_frame_kernel());
  kernels.push_back(inputs::check_frame_kernel());
  kernels.push_back(inputs::predict_tracks_kernel());
  kernels.push_back(inputs::locate_rois_kernel());
  kernels.push_back(inputs::correspond_kernel());
  kernels.push_back(inputs::assign_markers_kernel());
  kernels.push_back(inputs::name_few_kernel());
  kernels.push_back(inputs::refine_pose_kernel());
  kernels.push_back(inputs::anchor_head_kernel());
  kernels.push_back(inputs::follow_motion_kernel());
  kernels.push_back(inputs::track_tools_kernel());
}

void add_output_kernels(std::vector<std::unique_ptr<MeasuredKernel>>& kernels) {
  kernels.push_back(inputs::predict_tools_kernel());
  kernels.push_back(inputs::pack_can_kernel());
}

}  // namespace glint
