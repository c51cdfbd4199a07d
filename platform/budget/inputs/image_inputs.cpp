#include "platform/budget/inputs/image_inputs.hpp"

#include <algorithm>

namespace glint {

RunPattern random_pattern(CounterRandom& random, const Limits& limits) {
  RunPattern p;
  p.run = random.below(2) == 0 ? 1 : random.between(1, 62);
  p.gap = random.below(2) == 0 ? 1 : random.between(1, 40);
  p.rows = random.below(2) == 0 ? 1 : random.between(1, 62);
  p.skip = random.below(3);
  p.shift = random.below(3);
  p.x1 = limits.width;
  p.y0 = random.below(std::max(limits.height / 8, 1));
  p.y1 = limits.height;
  return p;
}

void add_image_kernels(std::vector<std::unique_ptr<MeasuredKernel>>& kernels) {
  kernels.push_back(measured_roi_threshold());
  kernels.push_back(measured_find_blobs());
  kernels.push_back(measured_back_project());
}

}  // namespace glint
