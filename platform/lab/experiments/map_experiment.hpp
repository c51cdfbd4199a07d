// Repeatability of a map of depth images: agreement with a second map of the same scene.
#pragma once

#include "platform/lab/experiments/case_list.hpp"

namespace glint {

// options.data: a folder as in platform/tools/mapping/depth_sequence.hpp. Compares even with odd
// images: the three largest planes before points are snapped to them, then the snapped points.
// Throws InputError if images are missing or invalid.
[[nodiscard]] CaseList run_map(const CaseOptions& options);

}  // namespace glint
