// Poses to calibrate with: from a trajectory file, a recording, or bare marker positions and the
// tool.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/tool.hpp"
#include "platform/tools/recorded_frames.hpp"

namespace glint {

// Of recorded frames' poses. By the head: the world where most frames have a head pose, else the
// camera's frame.
enum class PoseFrame { by_head, camera, world };

struct PoseSource {
  // TUM text or EuRoC-like CSV, of the tool's frame; or a recording (.mcap) of level blobs or more:
  // the tool in the camera's frame, each frame by itself; the tool is one of its own, by name.
  std::string poses;
  std::string points;   // unlabelled marker positions (CSV); needs the tool
  std::string tool;     // a tool file
  bool of_tip = false;  // the poses' origin is the tool's tip, as in a run's tip.tum
  // Recorded frames of any kind, tracked: the tool by the tracker's fit of each frame. The cell
  // file is as open_recorded() has it, the tool as select_tool().
  std::string recording, cell_file;
  PoseFrame frame = PoseFrame::by_head;
};

struct PoseSeries {
  std::vector<StampedPose> poses;  // stamps rise, from 0
  Time begin;                      // the first one's, as it stands in the file
  int unsolved = 0;                // point frames without a pose
  std::optional<Tool> tool;
  double scale_sigma = 0;            // of all positions, as the camera's ranges: of recorded frames
  std::string what;                  // the file, for messages
  std::string frame = "as in file";  // that the poses are in: of frames "world" or "camera"
  std::vector<std::string> failures;  // what of the frames could not be read, a line each
};

// Throws InputError for bad files, none or several of poses, points and recording, points without a
// tool, of_tip without a tool, and frames in none of which the tool is tracked.
[[nodiscard]] PoseSeries load_pose_series(const PoseSource& source);

// Of recorded frames: the cell's tool of this number.
[[nodiscard]] PoseSeries recorded_poses(RecordedFrames& recorded, std::size_t tool,
                                        PoseFrame frame);

}  // namespace glint
