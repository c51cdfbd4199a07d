// Verdicts of `glint verify`: it must agree with a device whose errors are as stated, and with no
// other.
//
// Each random seed draws a device, a tool and a headset of platform/sim/field.hpp. The tool touches
// two points and rests (platform/sim/touches.hpp). As stated: the errors have the stated
// distributions; the headset drifts at most as declared, where the field's may drift three times
// that. Below one sigma: every error is uniform within its stated standard deviation. Four sigma:
// one error is that large, the others are below one; range offset, range scale, principal point,
// tool geometry and the headset's drift take turns.
#pragma once

#include "platform/lab/experiments/case_list.hpp"

namespace glint {

[[nodiscard]] CaseList run_verify_experiment(const CaseOptions& options);

}  // namespace glint
