// Accuracy of blob centroids and consistency of their stated variances: rendered spheres at random
// subpixel positions, located by Glint and by three simpler methods.
#pragma once

#include "platform/lab/experiments/case_list.hpp"

namespace glint {

[[nodiscard]] CaseList run_centroid_experiment(const CaseOptions& options);

}  // namespace glint
