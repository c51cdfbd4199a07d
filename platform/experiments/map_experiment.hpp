// How well a map of depth pictures agrees with a second one of the same place.
#pragma once

#include "platform/experiments/case_list.hpp"

namespace glint {

// options.data: a folder as platform/mapping/depth_sequence.hpp describes. Even against odd
// pictures, the three largest planes before anything is moved onto them; then what was moved.
// Throws InputError where the pictures are missing or wrong.
[[nodiscard]] CaseList run_map(const CaseOptions& options);

}  // namespace glint
