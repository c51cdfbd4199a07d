#include "platform/budget/measured_kernel.hpp"

namespace glint {

std::vector<std::unique_ptr<MeasuredKernel>> measured_kernels() {
  std::vector<std::unique_ptr<MeasuredKernel>> kernels;
  add_image_kernels(kernels);
  add_pose_kernels(kernels);
  add_output_kernels(kernels);
  add_background_kernels(kernels);
  add_following_kernels(kernels);
  return kernels;
}

}  // namespace glint
