// One iteration of tool geometry estimation: labelled points, fit of poses and markers, new
// markers.
#pragma once

#include <span>
#include <vector>

#include "kernels/pose/labeling.hpp"
#include "kernels/pose/tool.hpp"
#include "platform/formats/points_csv.hpp"
#include "platform/tools/calibrate/bundle.hpp"

namespace glint {

struct NamedFrames {
  Tool tool;
  std::vector<Labeling> labels;  // of successive frames
};

struct ToolRound {
  std::vector<std::size_t> frames;  // of the recording; the bundle's poses are in this order
  std::vector<LabelledPoint> points;
  Bundle bundle;
  double noise_m = 0;
};

// Requires that the labels are those of frames `begin` and following.
[[nodiscard]] ToolRound round_of(std::span<const PointFrame> frames, std::size_t begin,
                                 const NamedFrames& named);

// Fits with a Cauchy loss of noise_m, removes outliers and frames with fewer than three points,
// fits again and estimates the noise. Leaves no points if nothing fits.
void fit(ToolRound& round, double noise_m);

// Number of frames with each marker.
[[nodiscard]] std::vector<int> seen_by_marker(const ToolRound& round);

// Returns the markers seen in at least this share of the frames, and other recurring points.
[[nodiscard]] std::vector<Vector3> next_markers(std::span<const PointFrame> frames,
                                                const ToolRound& round, double seen_min);

}  // namespace glint
