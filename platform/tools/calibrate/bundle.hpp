// Bundle adjustment of a tool: all poses and all markers from labelled marker positions.
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

// Least squares from the initial guess `start`; with a Cauchy loss of this sigma if sigma_m > 0.
[[nodiscard]] Bundle refined_bundle(Bundle start, std::span<const LabelledPoint> points,
                                    double sigma_m);

[[nodiscard]] Vector3 bundle_residual(const Bundle& bundle, const LabelledPoint& point);

// Noise of one component of a measured point, corrected for the degrees of freedom of the fit.
[[nodiscard]] double bundle_noise(const Bundle& bundle, std::span<const LabelledPoint> points);

// Standard deviation of each marker per axis, with the tool's pose free.
[[nodiscard]] std::vector<double> marker_sigmas(const Bundle& bundle,
                                                std::span<const LabelledPoint> points,
                                                double noise_m);

}  // namespace glint
