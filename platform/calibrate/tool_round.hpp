// One round of finding a tool's markers: named points, fitted poses and markers, what recurs.
#pragma once

#include <span>
#include <vector>

#include "kernels/pose/labeling.hpp"
#include "kernels/pose/tool.hpp"
#include "platform/calibrate/bundle.hpp"
#include "platform/sensors/points_csv.hpp"

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

// The labels are those of frames `begin` and on.
[[nodiscard]] ToolRound round_of(std::span<const PointFrame> frames, std::size_t begin,
                                 const NamedFrames& named);

// Fits with a Cauchy loss of noise_m, leaves outliers and frames without three points out, fits
// again and finds the noise. No points are left where nothing fits.
void fit(ToolRound& round, double noise_m);

// In how many frames each marker was seen.
[[nodiscard]] std::vector<int> seen_by_marker(const ToolRound& round);

// The markers that are seen in this share of the frames, and what else recurs at one place.
[[nodiscard]] std::vector<Vector3> next_markers(std::span<const PointFrame> frames,
                                                const ToolRound& round, double seen_min);

}  // namespace glint
