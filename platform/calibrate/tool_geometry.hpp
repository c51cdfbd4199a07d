// Where a tool's markers are on it, from unlabelled marker positions while it moves.
//
// Start: the points of one frame are the tool. Every frame is labelled by the tracker's own search;
// what is seldom seen goes, what recurs at one place of the tool comes in. Then Ceres: all poses
// and all markers at once with a Cauchy loss; outliers removed, labelled again with what is known
// now. A nearly symmetric tool is kept from being mixed up: from frame to frame names go on
// (segments), and of the ways to name a segment the one with the least sum of squares over all of
// it counts.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/pose/tool.hpp"
#include "platform/sensors/points_csv.hpp"

namespace glint {

struct ToolGeometrySettings {
  double noise_m = 0.001;     // of a marker, an axis: to begin with; found anew from the data
  double seen_min = 0.2;      // of all frames; a marker that is seen less is a stray
  double step_max_m = 0.03;   // from frame to frame; beyond it a new segment begins
  double longest_side_m = 0;  // known: all is scaled so that the longest side is; 0: as measured
  double turn_min_rad = 0.1;  // rms; less, and errors along one direction stay hidden
  int rounds = 4;
};

inline constexpr int k_tool_frames_min = 20;

struct ToolGeometry {
  std::vector<Vector3> markers_m;      // about their middle, along their principal axes
  std::vector<double> marker_sigma_m;  // an axis, root of the mean variance
  std::vector<int> seen;               // frames that each was seen in
  double noise_m = 0;                  // of a measured marker, an axis
  double scale = 1;                    // that longest_side_m asked for
  double turn_rad = 0;                 // rms turn of the tool's steadiest direction
  int frames = 0, frames_used = 0;
  int points = 0, points_used = 0;  // the others are strays and outliers
  int segments = 0;
  std::vector<double> residuals_m;  // rms of each frame used
};

// Throws InputError, naming `what` (a file), for too few frames or markers, markers on a line, too
// little motion, or points that are no rigid tool.
[[nodiscard]] ToolGeometry calibrate_tool(std::span<const PointFrame> frames,
                                          const ToolGeometrySettings& settings,
                                          const std::string& what);

}  // namespace glint
