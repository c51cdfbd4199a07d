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

struct LabelledFrames {
  Tool tool;
  std::vector<Labeling> labels;  // of successive frames
};

struct ToolIteration {
  std::vector<std::size_t> frames;  // of the recording; the bundle's poses are in this order
  std::vector<LabelledPoint> points;
  Bundle bundle;
  double noise_m = 0;
};

// Requires that the labels are those of frames `begin` and following.
[[nodiscard]] ToolIteration round_of(std::span<const PointFrame> frames, std::size_t begin,
                                     const LabelledFrames& named);

// Fits with a Cauchy loss of noise_m, removes outliers and frames with fewer than three points,
// fits again and estimates the noise. Leaves no points if nothing fits.
void fit(ToolIteration& round, double noise_m);

// Number of frames with each marker.
[[nodiscard]] std::vector<int> frame_counts_by_marker(const ToolIteration& round);

// Returns the markers seen in at least this share of the frames, and other recurring points.
[[nodiscard]] std::vector<Vector3> next_markers(std::span<const PointFrame> frames,
                                                const ToolIteration& round, double frame_share_min);

}  // namespace glint
