// A robot found in real depth frames and in simulated ones, from hundreds of rough poses.
//
// Real: five frames of an xArm7 (--data DIR), together and singly, with and without masks, seeds
// near and far, one frame left out, the robot cut out. A pose counts as wrong beyond 40 mm or 4
// degrees of the published one, as right within 20 mm and 2 degrees; between the two as neither.
// Simulated: UR5 and Panda, half hidden, the truth known.
#pragma once

#include "platform/experiments/case_list.hpp"

namespace glint {

[[nodiscard]] CaseList run_reference_experiment(const CaseOptions& options);

}  // namespace glint
