// Detection of calibration errors by a run: it must name the error that a device has, and none if
// all errors are small.
//
// Each random seed draws a device and a tool whose every error is below one stated standard
// deviation (uniform), and a headset and a robot of platform/sim/field.hpp. A case gives one source
// four standard deviations: the range offset, of either sign; each marker's position in the tool,
// per axis; with a reference body in view, the principal point, the focal length, the time offset
// or the headset's drift. Shipped settings, 30 s.
#pragma once

#include "platform/lab/experiments/case_list.hpp"

namespace glint {

[[nodiscard]] CaseList run_warnings(const CaseOptions& options);

}  // namespace glint
