// Range bias calibration of a time-of-flight camera for one kind of marker, with a tool of known
// size: offset, slope by range, and a term that grows with decreasing signal
// (kernels/pose/depth_bias.hpp).
//
// The tool's size and the markers' pixels determine the distance, to a tenth of a pixel in fifty.
// Ceres fits the bias and every frame's pose together, each residual in its own noise
// (kernels/calibrate/depth_residual.hpp), with a Cauchy loss; then the noise is estimated again,
// outliers are removed, and the fit is repeated without loss. An error of 0.1 % of focal length or
// tool size changes the slope by 1 mm a metre. The covariance contains the tool's share, by its
// marker_sigma_m; a cell adds the lens's. It does not contain the second-order effect of pose
// noise: 0.1 mm of the offset, 0.3 mm a metre and 0.4 mm of dim at 0.1 px and 2 mm.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/pose/depth_bias.hpp"
#include "platform/tools/calibrate/sightings.hpp"

namespace glint {

enum class Brightness { estimated, left_out };

struct DepthCalibrationSettings {
  Brightness brightness = Brightness::estimated;  // left_out: low_signal_m stays 0
  double span_min_m = 0.2;                        // of ranges, 5th to 95th percentile
  double dim_ratio_min = 2;                       // of peaks, 5th to 95th percentile
  double part_sigma_max_m = 0.001;                // effect of each unknown over the data's span
  double inlier_sigmas = 3.5;                     // rejects one valid range in 2000
  double inliers_min = 0.7;                       // share of all markers
  double pixel_sigma_max_px = 0.5;                // estimated; above it tool or lens is wrong
  double range_sigma_max_m = 0.015;
};

inline constexpr int k_depth_frames_min = 50;

struct DepthCalibration {
  DepthBias bias;
  Matrix3 covariance = Matrix3::Zero();          // of offset_m, per_metre, low_signal_m
  double range_dim_correlation = 0;              // between range and dimness of the data
  double pixel_sigma_px = 0, range_sigma_m = 0;  // estimated noise, rms over the markers
  double rms_before_m = 0, rms_after_m = 0;      // measured minus fitted range, of the kept markers
  double variance_inflation = 1;                 // by autocorrelation
  double range_from_m = 0, range_to_m = 0;       // 5th to 95th percentile
  double peak_from = 0, peak_to = 0;
  std::vector<double> residuals_m;  // of each marker's range after bias correction
  std::vector<bool> kept;
  int frames = 0, markers = 0, outliers = 0;
};

// Throws InputError, naming `what`, for too few frames, and for data that leave a part of the bias
// undetermined (names the part and the data needed).
[[nodiscard]] DepthCalibration calibrate_depth(std::span<const ToolObservation> observations,
                                               const Tool& tool,
                                               const DepthCalibrationSettings& settings,
                                               const std::string& what);

}  // namespace glint
