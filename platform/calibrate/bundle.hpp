// All poses and all markers of a tool at once, from labelled marker positions.
#pragma once

#include <span>
#include <vector>

#include "kernels/geometry.hpp"

namespace glint {

struct LabelledPoint {
  std::size_t frame = 0;   // index into the poses
  std::size_t marker = 0;  // index into the markers
  Vector3 measured_m = Vector3::Zero();
};

struct Bundle {
  std::vector<Pose> poses;         // T_file_tool
  std::vector<Vector3> markers_m;  // tool frame
};

// Least squares from `start` on; with a Cauchy loss of this sigma where sigma_m > 0.
[[nodiscard]] Bundle refined_bundle(Bundle start, std::span<const LabelledPoint> points,
                                    double sigma_m);

[[nodiscard]] Vector3 bundle_miss(const Bundle& bundle, const LabelledPoint& point);

// Of one component of one measured point: what the poses and markers took up counts.
[[nodiscard]] double bundle_noise(const Bundle& bundle, std::span<const LabelledPoint> points);

// Each marker's sigma an axis, with the tool's place and turn free.
[[nodiscard]] std::vector<double> marker_sigmas(const Bundle& bundle,
                                                std::span<const LabelledPoint> points,
                                                double noise_m);

}  // namespace glint
