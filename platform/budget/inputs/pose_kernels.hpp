// Measured kernels of the frame group from stamp to track, and of the tick group, with their
// inputs.
#pragma once

#include <memory>

#include "platform/budget/measured_kernel.hpp"

namespace glint::inputs {

[[nodiscard]] std::unique_ptr<MeasuredKernel> stamp_frame_kernel();
[[nodiscard]] std::unique_ptr<MeasuredKernel> check_frame_kernel();
[[nodiscard]] std::unique_ptr<MeasuredKernel> predict_tracks_kernel();
[[nodiscard]] std::unique_ptr<MeasuredKernel> locate_rois_kernel();
[[nodiscard]] std::unique_ptr<MeasuredKernel> correspond_kernel();
[[nodiscard]] std::unique_ptr<MeasuredKernel> assign_markers_kernel();
[[nodiscard]] std::unique_ptr<MeasuredKernel> name_few_kernel();
[[nodiscard]] std::unique_ptr<MeasuredKernel> refine_pose_kernel();
[[nodiscard]] std::unique_ptr<MeasuredKernel> anchor_head_kernel();
[[nodiscard]] std::unique_ptr<MeasuredKernel> follow_motion_kernel();
[[nodiscard]] std::unique_ptr<MeasuredKernel> track_tools_kernel();
[[nodiscard]] std::unique_ptr<MeasuredKernel> predict_tools_kernel();
[[nodiscard]] std::unique_ptr<MeasuredKernel> pack_can_kernel();

}  // namespace glint::inputs
