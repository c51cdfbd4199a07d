// Text export of recorded frames: marker positions, poses and the simulator's ground truth.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/wire/pose_sample.hpp"
#include "platform/runtime/session/frame_pose.hpp"
#include "platform/tools/inspect/recorded_frames.hpp"

namespace glint {

using LineOut = std::function<void(std::string_view)>;  // line without newline; may throw

struct PoseExport {
  std::size_t tool = 0;                          // index in the cell
  ReferenceFrame frame = ReferenceFrame::world;  // or camera
  PoseOrigin origin = PoseOrigin::tool;
};

struct ExportedRows {
  int frames = 0, rows = 0;
  int without_head_pose = 0;          // frames with a pose, skipped for lack of a head pose
  std::vector<std::string> failures;  // read errors, a line each
};

// Exports all markers with a range of every frame, searched completely: points_line(), camera
// frame, marker centres.
[[nodiscard]] ExportedRows export_points(RecordedFrames& recorded, std::size_t tool,
                                         const LineOut& out);

// Exports the fit of each frame with three or more markers of the tool: tum_line(). Throws
// InputError if there is none, or none with a head pose for the world frame.
[[nodiscard]] ExportedRows export_tum(RecordedFrames& recorded, const PoseExport& wanted,
                                      const LineOut& out);

// Exports each listed tool in each frame: frame_pose_line(), in the world frame if the frame has a
// head pose, else in the camera frame.
[[nodiscard]] ExportedRows export_csv(RecordedFrames& recorded,
                                      const std::vector<std::size_t>& tools, PoseOrigin origin,
                                      const LineOut& out);

// Exports the simulator's ground truth at each frame's time stamp: tum_line(). Throws InputError if
// the frames are not from the simulator of the recorded cell: compares number, time stamp, arrival
// (its jitter depends on the random seed) and head pose.
[[nodiscard]] ExportedRows export_ground_truth(RecordedFrames& recorded, const PoseExport& wanted,
                                               const LineOut& out);

}  // namespace glint
