// Pose estimation of a robot in real and simulated depth frames, from hundreds of rough initial
// poses.
//
// Real: five frames of an xArm7 (--data DIR), together and singly, with and without masks, initial
// poses near and far, one frame left out, the robot cut out. A pose is wrong beyond 40 mm or 4
// degrees of the published one, right within 20 mm and 2 degrees, otherwise neither. Simulated: UR5
// and Panda, half hidden, with ground truth.
#pragma once

#include "platform/lab/experiments/case_list.hpp"

namespace glint {

[[nodiscard]] CaseList run_reference_experiment(const CaseOptions& options);

}  // namespace glint
