// How the errors of a tracker's poses at rest go on in time: white noise and two Gauss-Markov
// processes (kernels/motion/correlated_errors.hpp), found by their Allan deviation.
//
// The Allan variance of each axis is linear in the three variances; of every pair of correlation
// times on a grid those variances are found by non-negative least squares, and the pair that fits
// all six axes best stands.
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

// One axis: metres or radians.
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
  // Whether the model lies within this factor of each deviation.
  double worst_factor = 1;
};

// Throws InputError, naming `what`, for fewer poses than k_noise_poses_min, a tool that moves, or
// poses that are all alike.
[[nodiscard]] NoiseCalibration calibrate_noise(std::span<const StampedPose> poses,
                                               const std::string& what);

// The model's Allan deviation of one axis, of means over `frames` poses.
[[nodiscard]] double allan_deviation(const AxisNoise& noise, const CorrelationTimes& correlation,
                                     double period_s, int frames);

// Poses of `poses` in the frame of the pose of `other` that lies nearest in time, at most
// `apart_max` beside it; others are left out.
[[nodiscard]] std::vector<StampedPose> relative_poses(std::span<const StampedPose> poses,
                                                      std::span<const StampedPose> other,
                                                      Duration apart_max);

// The errors of each marker that make such correlated errors of a tool's pose: slow_range_m,
// slow_centroid_px and fast_share of what the cell states otherwise.
[[nodiscard]] CameraUncertainty marker_errors_of(const NoiseCalibration& noise, const Cell& cell,
                                                 const Tool& tool, const Pose& T_camera_tool);

}  // namespace glint
