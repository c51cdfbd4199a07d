// Where a tool's markers are on it, from unlabelled marker positions while it moves.
//
// Start: the points of one frame are the tool. Every frame is labelled by the tracker's own search;
// what is seldom seen goes, what recurs at one place of the tool comes in. Then Ceres: all poses
// and all markers at once with a Cauchy loss; outliers removed, labelled again with what is known
// now. A nearly symmetric tool is kept from being mixed up: from frame to frame names go on
// (segments), and of the ways to name a segment the one with the least sum of squares over all of
// it counts.
//
// A tool that was drawn before it was made: the markers found are laid on the drawing's, so that
// its frame, its order of markers and, where no side was measured, its size hold on.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/pose/tool.hpp"
#include "platform/sensors/camera.hpp"
#include "platform/sensors/points_csv.hpp"
#include "platform/tools/recorded_frames.hpp"

namespace glint {

struct ToolGeometrySettings {
  double noise_m = 0.001;     // of a marker, an axis: to begin with; found anew from the data
  double seen_min = 0.2;      // of all frames; a marker that is seen less is a stray
  double step_max_m = 0.03;   // from frame to frame; beyond it a new segment begins
  double longest_side_m = 0;  // known: all is scaled so that the longest side is; 0: as measured
  double longest_side_sigma_m = 0;
  // Of each marker's range, what its slow errors leave of the mean over the recording.
  double slow_range_m = 0;
  std::optional<Tool> drawn;  // the markers come in its frame and order
  double turn_min_rad = 0.1;  // rms; less, and errors along one direction stay hidden
  int rounds = 4;
};

inline constexpr int k_tool_frames_min = 20;

struct ToolGeometry {
  std::vector<Vector3> markers_m;      // as drawn; else about their middle, along principal axes
  std::vector<double> marker_sigma_m;  // an axis, root of the mean variance
  std::vector<int> seen;               // frames that each was seen in
  double noise_m = 0;                  // of a measured marker, an axis
  double scale = 1;                    // that longest_side_m or the drawing asked for
  double drawn_rms_m = 0;              // of the markers' distances from where they were drawn
  double turn_rad = 0;                 // rms turn of the tool's steadiest direction
  int frames = 0, frames_used = 0;
  int points = 0, points_used = 0;  // the others are strays and outliers
  int segments = 0;
  std::vector<double> residuals_m;  // rms of each frame used
};

// Throws InputError, naming `what` (a file), for too few frames or markers, markers on a line, too
// little motion, points that are no rigid tool, or another tool than the drawn one.
[[nodiscard]] ToolGeometry calibrate_tool(std::span<const PointFrame> frames,
                                          const ToolGeometrySettings& settings,
                                          const std::string& what);

// settings.slow_range_m of frames that this camera saw.
[[nodiscard]] double slow_range_of_mean(std::span<const PointFrame> frames, const Camera& camera);

// All blobs with a range of recorded frames, each frame searched whole, in the camera's frame: a
// rigid tool needs no head pose. kind: radius and shape of the markers. failures: what could not be
// read, a line each.
[[nodiscard]] std::vector<PointFrame> recorded_points(RecordedFrames& recorded, const Tool& kind,
                                                      std::vector<std::string>& failures);

}  // namespace glint
