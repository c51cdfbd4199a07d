// Input poses of a calibration: from a trajectory file, a recording, or unlabelled marker positions
// with the tool.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/tool.hpp"
#include "platform/tools/inspect/recorded_frames.hpp"

namespace glint {

// Frame of poses from recorded frames. by_head: the world if most frames have a head pose, else the
// camera.
enum class PoseFrame { by_head, camera, world };

struct PoseSource {
  // TUM text or EuRoC-like CSV of the tool's frame, or a recording (.mcap) of level blobs or more.
  // A recording yields the tool in the camera's frame, each frame by itself; the tool is one of its
  // own, by name.
  std::string poses;
  std::string points;   // unlabelled marker positions (CSV); requires the tool
  std::string tool;     // a tool file
  bool of_tip = false;  // the poses' origin is the tool's tip, as in a run's tip.tum
  // Recorded frames of any kind, tracked: the tracker's fit of each frame. For the cell file see
  // open_recorded(), for the tool select_tool().
  std::string recording, cell_file;
  PoseFrame frame = PoseFrame::by_head;
};

struct PoseSeries {
  std::vector<TimedPose> poses;  // time stamps ascend, from 0
  Time begin;                    // the first time stamp as in the file
  int unsolved = 0;              // point frames without a pose
  std::optional<Tool> tool;
  double scale_sigma = 0;  // of all positions, from the camera's ranges; recorded frames only
  std::string what;        // file name, for messages
  std::string frame = "as in file";   // frame of the poses; of recorded frames "world" or "camera"
  std::vector<std::string> failures;  // read errors of the frames, a line each
};

// Throws InputError for bad files, none or several of poses, points and recording, points without a
// tool, of_tip without a tool, and recorded frames in which the tool is never tracked.
[[nodiscard]] PoseSeries load_pose_series(const PoseSource& source);

// For recorded frames; `tool` is the index of the cell's tool.
[[nodiscard]] PoseSeries recorded_poses(RecordedFrames& recorded, std::size_t tool,
                                        PoseFrame frame);

}  // namespace glint
