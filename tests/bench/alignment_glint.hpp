// Glint's side of the alignment benchmark: ICP with kernels/registration on two point clouds.
#pragma once

#include <vector>

#include "alignment_steps.hpp"
#include "kernels/registration/match_points.hpp"

namespace glint::bench {

// Coarse to fine, as align_model.hpp on depth images. Allocates once, for targets of at most
// `points` points.
class CloudAlignment {
 public:
  explicit CloudAlignment(int points);
  void run(const AlignmentTask& task, Matching matching, AlignmentAnswer& answer);

 private:
  PointGrid grid_;
  std::vector<VisiblePoint> some_;
  std::vector<Vector3f> target_;
};

}  // namespace glint::bench
