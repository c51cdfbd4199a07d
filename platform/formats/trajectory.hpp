// Reader of recorded trajectories (TUM text, EuRoC-like CSV) and their interpolation.
#pragma once

#include <string>
#include <vector>

#include "kernels/motion/interpolate.hpp"

namespace glint {

struct Trajectory {
  std::string name;                // the file, for messages
  std::vector<TimedPose> samples;  // rising stamps, from 0
  Time begin;                      // the first stamp, as in the file

  [[nodiscard]] Duration length() const {
    return samples.empty() ? Duration{} : samples.back().time - samples.front().time;
  }
};

// The first data line selects the format: blanks are TUM (`t x y z qx qy qz qw`, seconds), commas
// are EuRoC (`ns, px, py, pz, qw, qx, qy, qz`, further columns ignored). Lines with # are headers.
// Throws InputError with file:line for text, NaN, missing columns, an invalid quaternion, stamps
// that do not rise, fewer than 2 samples.
[[nodiscard]] Trajectory load_trajectory(const std::string& path);
[[nodiscard]] Trajectory trajectory_from_text(const std::string& text, const std::string& name);

// Interpolates positions by a cubic through four samples (Catmull and Rom 1974, for non-uniform
// stamps) and orientations by SLERP. Positions are linear in gaps longer than 0.1 s and in the
// first and last interval. Outside of the recording, time is mirrored, so that the pose has no
// jump.
[[nodiscard]] Pose interpolated(const Trajectory& trajectory, Time time);

}  // namespace glint
