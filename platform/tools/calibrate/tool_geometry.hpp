// Marker geometry of a rigid tool from unlabelled marker positions while it moves: labeling, then
// bundle adjustment of all poses and markers.
//
// Initial guess: the points of one frame are the tool. The tracker's own search labels every frame;
// rarely seen markers are removed, and points that recur at one position of the tool become
// markers. Then Ceres fits all poses and markers with a Cauchy loss, outliers are removed, and the
// frames are labelled again with the result. A nearly symmetric tool is ambiguous in single frames.
// Therefore labels continue from frame to frame within a segment. Of the alternative labelings of a
// segment, the one with the least sum of squares over all its frames is used.
//
// With a drawing of the tool, the markers are registered to the drawing's: its frame, its marker
// order and, if no side was measured, its size are kept.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/pose/tool.hpp"
#include "platform/formats/camera.hpp"
#include "platform/formats/points_csv.hpp"
#include "platform/tools/inspect/recorded_frames.hpp"

namespace glint {

struct ToolGeometrySettings {
  double noise_m = 0.001;  // of a marker, per axis: initial value; estimated again from the data
  double frame_share_min =
      0.2;                    // share of all frames; a marker seen less often is rejected as stray
  double step_max_m = 0.03;   // between frames; a longer step begins a new segment
  double longest_side_m = 0;  // measured; scales the markers to it; 0: no scaling
  double longest_side_sigma_m = 0;
  // Remaining effect of slow range errors on the mean of each marker over the recording.
  double correlated_range_m = 0;
  std::optional<Tool> drawn;  // the markers are returned in its frame and order
  // rms; with less motion, errors along one direction are undetected
  double rotation_min_rad = 0.1;
  int rounds = 4;
};

inline constexpr int k_tool_frames_min = 20;

struct ToolGeometry {
  std::vector<Vector3> markers_m;      // drawing's frame; else centroid and principal axes
  std::vector<double> marker_sigma_m;  // per axis, root of the mean variance
  std::vector<int> frame_counts;       // number of frames with each marker
  double noise_m = 0;                  // of a measured marker, per axis
  double scale = 1;                    // applied for longest_side_m or the drawing
  double drawn_rms_m = 0;              // distances of the markers from the drawing's
  double rotation_spread_rad = 0;      // rms rotation of the tool's steadiest direction
  int frames = 0, frames_used = 0;
  int points = 0, points_used = 0;  // the others are strays and outliers
  int segments = 0;
  std::vector<double> residuals_m;  // rms of each used frame
};

// Throws InputError, naming `what` (a file), for too few frames or markers, markers on a line, too
// little motion, points of no rigid tool, and a tool other than the drawn one.
[[nodiscard]] ToolGeometry calibrate_tool(std::span<const PointFrame> frames,
                                          const ToolGeometrySettings& settings,
                                          const std::string& what);

// Returns settings.correlated_range_m for frames of this camera.
[[nodiscard]] double slow_range_of_mean(std::span<const PointFrame> frames, const Camera& camera);

// Returns all blobs with a range, each frame searched completely, in the camera's frame: a rigid
// tool needs no head pose. kind: radius and shape of the markers. failures: read errors, a line
// each.
[[nodiscard]] std::vector<PointFrame> recorded_points(RecordedFrames& recorded, const Tool& kind,
                                                      std::vector<std::string>& failures);

}  // namespace glint
