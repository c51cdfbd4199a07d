// Tip accuracy after ASTM F2554 on simulated frames: on a single point, under rotation about each
// axis of the tool, and as distances between points. The tracker is unchanged.
//
// Each frame is tracked independently, in the camera frame, so that neither a filter nor the
// headset's localisation affects the result.
#pragma once

#include "platform/lab/experiments/case_list.hpp"

namespace glint {

[[nodiscard]] CaseList run_f2554(const CaseOptions& options);

}  // namespace glint
