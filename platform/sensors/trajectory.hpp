// Recorded motion: TUM text or EuRoC-like CSV.
#pragma once

#include <string>
#include <vector>

#include "kernels/motion/interpolate.hpp"

namespace glint {

struct Trajectory {
  std::string name;                  // the file, for messages
  std::vector<StampedPose> samples;  // stamps rise, from 0
  Time begin;                        // the first one's, as it stands in the file

  [[nodiscard]] Duration length() const {
    return samples.empty() ? Duration{} : samples.back().time - samples.front().time;
  }
};

// Told apart by the first data line: blanks are TUM (`t x y z qx qy qz qw`, seconds), commas are
// EuRoC (`ns, px, py, pz, qw, qx, qy, qz`, further columns ignored). Lines with # are headers.
// Throws InputError with file:line for text, NaN, missing columns, a quaternion that is none,
// stamps that do not rise, fewer than 2 samples.
[[nodiscard]] Trajectory load_trajectory(const std::string& path);
[[nodiscard]] Trajectory trajectory_from_text(const std::string& text, const std::string& name);

// Positions between samples by a cubic through four (Catmull and Rom 1974, for uneven stamps),
// orientations by SLERP; within gaps longer than 0.1 s both are straight. Before the first and
// after the last sample the recording runs on, mirrored in time, so that it never jumps.
[[nodiscard]] Pose interpolated(const Trajectory& trajectory, Time time);

}  // namespace glint
