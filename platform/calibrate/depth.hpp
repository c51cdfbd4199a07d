// By how much a camera's ranges to one kind of marker are too long: offset, slope by range and the
// part that grows as the marker gets dim (kernels/pose/depth_bias.hpp), from a tool of known size.
//
// The tool's size and the markers' pixels say how far away it is, a tenth of a pixel in fifty; the
// bias and every frame's pose are found together by Ceres, each residual in its own noise
// (kernels/calibrate/depth_residual.hpp), with a Cauchy loss, the noise anew, outliers removed, and
// without loss again. A wrong focal length or tool size of 0.1 % is 1 mm a metre of the slope: the
// covariance has the tool's, by its marker_sigma_m, and a cell adds its lens's. What the poses'
// noise does in second order, 0.1 mm of the offset, 0.3 mm a metre and 0.4 mm of dim at 0.1 px and
// 2 mm, is not in it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/pose/depth_bias.hpp"
#include "platform/calibrate/sightings.hpp"

namespace glint {

enum class Brightness { estimated, left_out };

struct DepthCalibrationSettings {
  Brightness brightness = Brightness::estimated;  // left_out: dim_m stays 0
  double span_min_m = 0.2;                        // of range, from the 5th to the 95th percentile
  double dim_ratio_min = 2;                       // of brightness, likewise
  double part_sigma_max_m = 0.001;                // of what each unknown does over the data's span
  double inlier_sigmas = 3.5;                     // one good range in 2000 is left out
  double inliers_min = 0.7;                       // of all markers
  double pixel_sigma_max_px = 0.5;                // as found: more, and tool or lens are others
  double range_sigma_max_m = 0.015;
};

inline constexpr int k_depth_frames_min = 50;

struct DepthCalibration {
  DepthBias bias;
  Matrix3 covariance = Matrix3::Zero();          // of offset_m, per_metre, dim_m
  double range_dim_correlation = 0;              // of what was seen: dim and far away go together
  double pixel_sigma_px = 0, range_sigma_m = 0;  // as found: rms of what is declared for each
  double rms_before_m = 0, rms_after_m = 0;      // of range less the fitted one's, of what is kept
  double correlated = 1;                         // so many frames in a row tell no more than one
  double range_from_m = 0, range_to_m = 0;       // 5th to 95th percentile
  double peak_from = 0, peak_to = 0;
  std::vector<double> misses_m;  // of each marker's range, the bias taken off
  std::vector<bool> kept;
  int frames = 0, markers = 0, outliers = 0;
};

// Throws InputError, naming `what`, for too few frames, and for data that leave a part of the bias
// open: which, and what to show the camera.
[[nodiscard]] DepthCalibration calibrate_depth(std::span<const Sighting> sightings,
                                               const Tool& tool,
                                               const DepthCalibrationSettings& settings,
                                               const std::string& what);

}  // namespace glint
