// How well a tip is located, in the manner of ASTM F2554: on one point, turned about each axis of
// the tool, and from point to point, on simulated frames with the tracker as it is.
//
// Every frame is tracked by itself, in the camera's frame, so that neither a filter nor the
// headset's localisation has a part in it.
#pragma once

#include "platform/experiments/case_list.hpp"

namespace glint {

[[nodiscard]] CaseList run_f2554(const CaseOptions& options);

}  // namespace glint
