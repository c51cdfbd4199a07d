// The frames and clocks of two trackers as `glint calibrate align` wrote them down.
#pragma once

#include <string>
#include <vector>

#include "kernels/motion/interpolate.hpp"

namespace glint {

struct Alignment {
  Pose T_reference_poses;  // of the poses' frame in the reference's
  Pose T_tool_body;        // of the reference's body in the tool's frame
  double offset_s = 0;     // the reference's stamp of an instant, less the poses' stamp
};

// Throws InputError: file:line, what was found, what was expected.
[[nodiscard]] Alignment load_alignment(const std::string& file);

// What the reference saw, as the poses' tracker would have: the tool, in the poses' frame and time.
[[nodiscard]] std::vector<StampedPose> in_poses_frame(std::vector<StampedPose> reference,
                                                      const Alignment& alignment);

}  // namespace glint
