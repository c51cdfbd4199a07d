// Alignment of two trackers (frames and clocks), read from a file of `glint calibrate align`.
#pragma once

#include <string>
#include <vector>

#include "kernels/motion/interpolate.hpp"

namespace glint {

struct Alignment {
  Pose T_reference_poses;  // of the poses' frame in the reference's
  Pose T_tool_body;        // of the reference's body in the tool's frame
  double offset_s = 0;     // reference's time stamp of an instant, less the poses' time stamp
};

// Throws InputError: file:line, what was found, what was expected.
[[nodiscard]] Alignment load_alignment(const std::string& file);

// Converts the reference's body poses into tool poses, in the poses' frame and time.
[[nodiscard]] std::vector<TimedPose> in_poses_frame(std::vector<TimedPose> reference,
                                                    const Alignment& alignment);

}  // namespace glint
