// Noise identification of a static tool's poses by Allan variance: white noise and two Gauss-Markov
// processes (kernels/motion/correlated_errors.hpp).
//
// The Allan variance of each axis is linear in the three variances. For every pair of correlation
// times on a grid, non-negative least squares yields those variances; the pair that fits all six
// axes best is the result.
// Source: Allan 1966, Statistics of atomic frequency standards; IEEE Std 952-1997, annex C.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "kernels/motion/motion_state.hpp"
#include "kernels/pose/systematic_covariance.hpp"
#include "platform/cells/cell.hpp"

namespace glint {

inline constexpr int k_noise_poses_min = 100;
inline constexpr std::size_t k_pose_axes = 6;

// Noise of one axis: metres or radians.
struct AxisNoise {
  double white = 0, fast = 0, slow = 0;  // standard deviations
};

struct AllanPoint {
  double seconds = 0;
  std::array<double, k_pose_axes> measured{}, model{};  // deviations
};

struct NoiseCalibration {
  std::array<AxisNoise, k_pose_axes> axes;  // x, y, z, rotation about x, y, z
  CorrelationTimes correlation;
  std::vector<AllanPoint> allan;
  double period_s = 0, duration_s = 0;
  int poses = 0;
  // Largest ratio between model and measured deviation, in either direction.
  double worst_factor = 1;
};

// Throws InputError, naming `what`, for fewer poses than k_noise_poses_min, a moving tool, and
// identical poses.
[[nodiscard]] NoiseCalibration calibrate_noise(std::span<const TimedPose> poses,
                                               const std::string& what);

// Returns the model's Allan deviation of one axis for means over `frames` poses.
[[nodiscard]] double allan_deviation(const AxisNoise& noise, const CorrelationTimes& correlation,
                                     double period_s, int frames);

// Returns `poses` relative to the pose of `other` nearest in time; skips those farther than
// `apart_max`.
[[nodiscard]] std::vector<TimedPose> relative_poses(std::span<const TimedPose> poses,
                                                    std::span<const TimedPose> other,
                                                    Duration apart_max);

// Returns the marker errors that cause such correlated pose errors: correlated_range_m,
// correlated_centroid_px and fast_share; the other fields are the cell's.
[[nodiscard]] CameraUncertainty marker_errors_of(const NoiseCalibration& noise, const Cell& cell,
                                                 const Tool& tool, const Pose& T_camera_tool);

}  // namespace glint
