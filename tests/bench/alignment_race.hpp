// Two clouds of one surface without a common point, 9 cm and 5 degrees apart, brought together by
// the Point Cloud Library and by Glint in turn.
#pragma once

#include "alignment_steps.hpp"
#include "kernels/cloud/point_cloud.hpp"

namespace glint::bench {

// surface: points with normals. Without a rival Glint's rows stand alone. False: a bar is missed.
[[nodiscard]] bool race_alignments(const PointCloud& surface, RunAlignment rival, int rounds);

}  // namespace glint::bench
