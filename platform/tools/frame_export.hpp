// Lines of text out of recorded frames: marker positions, poses and the simulator's truth.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/wire/pose_sample.hpp"
#include "platform/tools/recorded_frames.hpp"

namespace glint {

using LineOut = std::function<void(std::string_view)>;  // without its newline; may throw

enum class PoseOrigin { tool, tip };

struct PoseExport {
  std::size_t tool = 0;                          // of the cell
  ReferenceFrame frame = ReferenceFrame::world;  // or camera
  PoseOrigin origin = PoseOrigin::tool;
};

struct ExportedRows {
  int frames = 0, rows = 0;
  int without_head_pose = 0;          // frames with a pose that were left out, for the world
  std::vector<std::string> failures;  // of the source, a line each
};

// All markers with a range of every frame, searched whole: points_line(), in the camera's frame,
// centres as the tool's markers have them.
[[nodiscard]] ExportedRows export_points(RecordedFrames& recorded, std::size_t tool,
                                         const LineOut& out);

// The fit of each frame in which three markers or more gave the tool's pose: tum_line(). Throws
// InputError where there is none, or none with a head pose for the world.
[[nodiscard]] ExportedRows export_tum(RecordedFrames& recorded, const PoseExport& wanted,
                                      const LineOut& out);

// Each tool listed, each frame: frame_pose_line(), in the world where the frame has a head pose,
// else in the camera's frame.
[[nodiscard]] ExportedRows export_csv(RecordedFrames& recorded,
                                      const std::vector<std::size_t>& tools, PoseOrigin origin,
                                      const LineOut& out);

// What the simulator that made the frames placed at each frame's stamp: tum_line(). Throws
// InputError where the frames are not those of the recorded cell's simulator: number, stamp,
// arrival (its jitter follows the random seed) and head pose are compared.
[[nodiscard]] ExportedRows export_truth(RecordedFrames& recorded, const PoseExport& wanted,
                                        const LineOut& out);

}  // namespace glint
