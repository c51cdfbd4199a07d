// Whether a run names the calibration error that a device has, and none where its errors are small.
//
// Each random seed draws a device and a tool whose every error is below one stated standard
// deviation (even), and a headset and a robot of platform/sim/field.hpp. A case gives one source
// four standard deviations: the range's offset either way; each marker's place in the tool, an
// axis; the principal point and the focal length, with a reference body in view. Shipped settings,
// 30 s.
#pragma once

#include "platform/experiments/case_list.hpp"

namespace glint {

[[nodiscard]] CaseList run_warnings(const CaseOptions& options);

}  // namespace glint
