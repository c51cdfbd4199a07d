// Kernels of glint_measure_crowd: the frame group at every point of the cost curve.
#include "platform/budget/curve/crowd_kernel.hpp"

namespace glint {

std::vector<std::unique_ptr<MeasuredKernel>> measured_kernels() {
  std::vector<std::unique_ptr<MeasuredKernel>> kernels;
  for (const DenseScenePoint& point : crowd_points()) {
    kernels.push_back(std::make_unique<DenseSceneKernel>(point));
  }
  return kernels;
}

}  // namespace glint
