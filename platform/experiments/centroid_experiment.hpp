// How far centroids are off, and whether they say so: rendered spheres at random places between
// the pixels, located by Glint and by three simpler methods.
#pragma once

#include "platform/experiments/case_list.hpp"

namespace glint {

[[nodiscard]] CaseList run_centroid_experiment(const CaseOptions& options);

}  // namespace glint
