// Benchmark of the alignment of two point clouds of one surface without a common point, 9 cm and 5
// degrees apart: the Point Cloud Library and Glint in turn.
#pragma once

#include "alignment_steps.hpp"
#include "kernels/cloud/point_cloud.hpp"

namespace glint::bench {

// surface: points with normals. Without `rival` only Glint's rows are measured. Returns false if a
// limit is missed.
[[nodiscard]] bool benchmark_alignments(const PointCloud& surface, RunAlignment rival, int rounds);

}  // namespace glint::bench
