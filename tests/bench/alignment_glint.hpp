// Glint's side of the alignment race: the pairs and steps of kernels/registration on two clouds.
#pragma once

#include <vector>

#include "alignment_steps.hpp"
#include "kernels/registration/match_points.hpp"

namespace glint::bench {

// Coarse to fine, as align_model.hpp does it on pictures; memory once, for targets of at most so
// many points.
class CloudAlignment {
 public:
  explicit CloudAlignment(int points);
  void run(const AlignmentTask& task, Matching matching, AlignmentAnswer& answer);

 private:
  PointGrid grid_;
  std::vector<SeenPoint> some_;
  std::vector<Vector3f> target_;
};

}  // namespace glint::bench
