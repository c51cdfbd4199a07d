// Motion state of a tool at one time: pose, velocities and accelerations with their covariance.
//
// The pose is that of a frame at the tool's reference point (the centre of its markers), because
// errors of position and rotation are nearly uncorrelated there. Velocities, accelerations and
// errors are along the fixed axes of the pose's parent frame: p = p^ + dp, R = Exp(dtheta) R^.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"

namespace glint {

using Vector6 = Eigen::Matrix<double, 6, 1>;

// First index of each triple in the error vector.
inline constexpr int k_position = 0, k_velocity = 3, k_acceleration = 6;
inline constexpr int k_rotation = 9, k_angular_velocity = 12, k_angular_acceleration = 15;
inline constexpr int k_motion_size = 18;
using MotionStateError = Eigen::Matrix<double, k_motion_size, 1>;
using MotionCovariance = Eigen::Matrix<double, k_motion_size, k_motion_size>;

struct MotionState {
  Time time;
  Pose pose;
  Vector3 velocity_m_s = Vector3::Zero();
  Vector3 acceleration_m_s2 = Vector3::Zero();
  Vector3 angular_velocity_rad_s = Vector3::Zero();
  Vector3 angular_acceleration_rad_s2 = Vector3::Zero();
  MotionCovariance covariance = MotionCovariance::Zero();
};

// A pose with its covariance in the order (x, y, z, rx, ry, rz), metres and radians.
struct UncertainPose {
  Time time;
  Pose pose;
  Matrix6 covariance = Matrix6::Zero();
};

// Measured position of one marker, whose position in the tool's reference frame is `model_m`.
struct MeasuredPoint {
  Vector3 model_m = Vector3::Zero();
  Vector3 measured_m = Vector3::Zero();
  Matrix3 covariance_m2 = Matrix3::Zero();
};

}  // namespace glint
