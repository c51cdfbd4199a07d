// Experiments static and dynamic of the publication with a reference body in view: drift correction
// with shipped settings while the headset's drift differs from the declared one.
//
// The drift is 0.3, 1 and 3 times that of the published experiments (scenarios.hpp). That drift is
// two to three times what the shipped cell declares at rest, 8 to 30 times in motion. 20 random
// seeds each; figures as in experiment.hpp.
#pragma once

#include "platform/lab/experiments/case_list.hpp"

namespace glint {

[[nodiscard]] CaseList run_drift_correction(const CaseOptions& options);

}  // namespace glint
