#include "kernels/motion/motion_filter.hpp"

#include <array>

#include "kernels/motion/cholesky.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/motion/singer.hpp"

namespace glint {
namespace {

template <int M>
using Gain = Eigen::Matrix<double, k_motion_size, M>;

// Initial standard deviation of the acceleration, each axis, of a tool that a hand brings into
// view. A reach of 0.7 m within 0.75 s has 5.1 m/s^2 rms (minimum jerk: Flash and Hogan 1985). The
// stationary value of the model, 0.7 m/s^2, holds for work in view.
constexpr double k_start_acceleration_m_s2 = 5;

void set_variance(MotionState& state, int block, double variance) {
  for (int i = 0; i < 3; ++i) state.covariance(block + i, block + i) = variance;
}

// p = F p for the three triples of translation or of rotation, the first of them at row `row`.
// `rotation` and `half_rotation` propagate an earlier rotation error to the later time.
void propagate_rows(MotionCovariance& p, int row, const SingerStep& step, const Matrix3& rotation,
                    const Matrix3& half_rotation) {
  using Rows = Eigen::Matrix<double, 3, k_motion_size>;
  const int speed = row + 3, acceleration = row + 6;
  const Rows gathered = step.seconds * p.middleRows<3>(speed) +
                        step.position_by_acceleration * p.middleRows<3>(acceleration);
  const Rows rotated_rows = rotation.lazyProduct(p.middleRows<3>(row));
  p.middleRows<3>(row) = rotated_rows + half_rotation.lazyProduct(gathered);
  p.middleRows<3>(speed) += step.velocity_by_acceleration * p.middleRows<3>(acceleration);
  p.middleRows<3>(acceleration) *= step.acceleration_decay;
}

// The transition from a state to a later time.
struct Step {
  SingerStep linear, angular;
  Quaternion rotation;
  Matrix3 rotation_matrix, half_matrix;
};

Step step_of(const MotionState& state, Time time, const MotionSettings& settings) {
  const double seconds = (time - state.time).seconds();
  Step step;
  step.linear = singer_step(settings.linear_damping_1_s, seconds);
  step.angular = singer_step(settings.angular_damping_1_s, seconds);
  const Vector3 rotation_vector =
      step.angular.seconds * state.angular_velocity_rad_s +
      step.angular.position_by_acceleration * state.angular_acceleration_rad_s2;
  step.rotation = from_rotation_vector(rotation_vector);
  step.rotation_matrix = step.rotation.toRotationMatrix();
  // The left Jacobian of a rotation is the rotation by half its vector, up to rotation_vector^2
  // / 24.
  step.half_matrix = from_rotation_vector(0.5 * rotation_vector).toRotationMatrix();
  return step;
}

// p = F p
void apply_transition(const Step& step, MotionCovariance& p) {
  propagate_rows(p, k_position, step.linear, Matrix3::Identity(), Matrix3::Identity());
  propagate_rows(p, k_rotation, step.angular, step.rotation_matrix, step.half_matrix);
}

void add_noise(MotionCovariance& p, int row, const Matrix3& noise) {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      for (int i = 0; i < 3; ++i) p(row + 3 * a + i, row + 3 * b + i) += noise(a, b);
}

// p = T p T', where T rotates each triple of errors by `rotation`.
void rotate_errors(MotionCovariance& p, const Matrix3& rotation) {
  for (int side = 0; side < 2; ++side) {  // T P, then T (T P)' = T P T'
    for (int row = 0; row < k_motion_size; row += 3)
      p.middleRows<3>(row) = rotation.lazyProduct(p.middleRows<3>(row)).eval();
    p.transposeInPlace();
  }
}

// Kalman update; ph: P H'; s: H P H' + R.
template <int M>
Correction correct(MotionState& state, const Gain<M>& ph, const Eigen::Matrix<double, M, M>& s,
                   const Eigen::Matrix<double, M, 1>& innovation) {
  Correction correction;
  const Cholesky<M> factor(s);
  if (!factor.positive) {
    correction.reason = Reason::degenerate;
    return correction;
  }
  Eigen::Matrix<double, M, k_motion_size> w;
  for (int i = 0; i < k_motion_size; ++i) w.col(i) = factor.forward(ph.row(i).transpose());
  const Eigen::Matrix<double, M, 1> whitened = factor.forward(innovation);
  correction.nis = whitened.squaredNorm();
  add_error(state, w.transpose().lazyProduct(whitened));
  state.covariance -= w.transpose().lazyProduct(w);
  return correction;
}

// Mean and covariance of the second-order term dtheta x (dtheta x lever) / 2 at the end of a lever
// arm, for a rotation error dtheta of covariance `rotation`. Each axis is a quadratic form of
// dtheta.
struct SecondOrder {
  Vector3 mean;
  Matrix3 covariance;
};

SecondOrder second_order(const Vector3& lever, const Matrix3& rotation) {
  std::array<Matrix3, 3> forms;  // quadratic form times the covariance
  SecondOrder out;
  for (int i = 0; i < 3; ++i) {
    Matrix3 form = -lever(i) * Matrix3::Identity();
    form.row(i) += 0.5 * lever.transpose();
    form.col(i) += 0.5 * lever;
    forms[static_cast<std::size_t>(i)] = form.lazyProduct(rotation);
    out.mean(i) = 0.5 * forms[static_cast<std::size_t>(i)].trace();
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      out.covariance(i, j) = 0.5 * Matrix3(forms[static_cast<std::size_t>(i)].lazyProduct(
                                               forms[static_cast<std::size_t>(j)]))
                                       .trace();
  return out;
}

}  // namespace

MotionState initial_motion_state(const UncertainPose& first,
                                 const MotionSettings& settings) noexcept {
  MotionState state;
  state.time = first.time;
  state.pose = first.pose;
  state.covariance.block<3, 3>(k_position, k_position) = first.covariance.topLeftCorner<3, 3>();
  state.covariance.block<3, 3>(k_position, k_rotation) = first.covariance.topRightCorner<3, 3>();
  state.covariance.block<3, 3>(k_rotation, k_position) = first.covariance.bottomLeftCorner<3, 3>();
  state.covariance.block<3, 3>(k_rotation, k_rotation) = first.covariance.bottomRightCorner<3, 3>();
  set_variance(state, k_velocity, settings.start_speed_m_s * settings.start_speed_m_s);
  set_variance(state, k_angular_velocity,
               settings.start_angular_speed_rad_s * settings.start_angular_speed_rad_s);
  set_variance(state, k_acceleration, k_start_acceleration_m_s2 * k_start_acceleration_m_s2);
  // The stationary variance of a damped acceleration.
  set_variance(state, k_angular_acceleration,
               settings.angular_noise_rad2_s5 / (2 * settings.angular_damping_1_s));
  return state;
}

void propagate(MotionState& state, Time time, const MotionSettings& settings,
               const NoiseScale& scale) noexcept {
  if (time <= state.time) return;
  const Step step = step_of(state, time, settings);
  const SingerStep &linear = step.linear, &angular = step.angular;
  state.time = time;
  state.pose.translation += linear.seconds * state.velocity_m_s +
                            linear.position_by_acceleration * state.acceleration_m_s2;
  state.velocity_m_s += linear.velocity_by_acceleration * state.acceleration_m_s2;
  state.acceleration_m_s2 *= linear.acceleration_decay;
  state.pose.rotation = (step.rotation * state.pose.rotation).normalized();
  state.angular_velocity_rad_s +=
      angular.velocity_by_acceleration * state.angular_acceleration_rad_s2;
  state.angular_acceleration_rad_s2 *= angular.acceleration_decay;

  MotionCovariance& p = state.covariance;
  for (int side = 0; side < 2; ++side) {  // F P, then F (F P)' = F P F'
    apply_transition(step, p);
    p.transposeInPlace();
  }
  // Symmetrise: asymmetry by rounding would grow with the square of time.
  p = (0.5 * (p + p.transpose())).eval();
  add_noise(p, k_position, (scale.linear * settings.linear_noise_m2_s5) * linear.noise);
  add_noise(p, k_rotation, (scale.angular * settings.angular_noise_rad2_s5) * angular.noise);
}

MotionCovariance transition_to(const MotionState& state, Time time,
                               const MotionSettings& settings) noexcept {
  MotionCovariance f = MotionCovariance::Identity();
  if (time > state.time) apply_transition(step_of(state, time, settings), f);
  return f;
}

void add_error(MotionState& state, const MotionStateError& error) noexcept {
  state.pose.translation += error.segment<3>(k_position);
  state.velocity_m_s += error.segment<3>(k_velocity);
  state.acceleration_m_s2 += error.segment<3>(k_acceleration);
  state.pose.rotation =
      (from_rotation_vector(error.segment<3>(k_rotation)) * state.pose.rotation).normalized();
  state.angular_velocity_rad_s += error.segment<3>(k_angular_velocity);
  state.angular_acceleration_rad_s2 += error.segment<3>(k_angular_acceleration);
}

MotionStateError motion_difference(const MotionState& a, const MotionState& b) noexcept {
  MotionStateError error;
  error << a.pose.translation - b.pose.translation, a.velocity_m_s - b.velocity_m_s,
      a.acceleration_m_s2 - b.acceleration_m_s2,
      rotation_vector(a.pose.rotation * b.pose.rotation.conjugate()),
      a.angular_velocity_rad_s - b.angular_velocity_rad_s,
      a.angular_acceleration_rad_s2 - b.angular_acceleration_rad_s2;
  return error;
}

Correction correct_by_pose(MotionState& state, const UncertainPose& measured) noexcept {
  Gain<6> ph;
  ph << state.covariance.middleCols<3>(k_position), state.covariance.middleCols<3>(k_rotation);
  Matrix6 s;
  s << ph.middleRows<3>(k_position), ph.middleRows<3>(k_rotation);
  s += measured.covariance;
  const Vector6 innovation = pose_difference(measured.pose, state.pose);
  Correction correction = correct<6>(state, ph, s, innovation);
  if (correction.reason != Reason::none) return correction;
  correction.linear_whitened = Cholesky<3>(s.topLeftCorner<3, 3>()).forward(innovation.head<3>());
  correction.linear_nis = correction.linear_whitened.squaredNorm();
  correction.angular_nis =
      Cholesky<3>(s.bottomRightCorner<3, 3>()).squared_length(innovation.tail<3>());
  return correction;
}

Correction correct_by_point(MotionState& state, const MeasuredPoint& measured) noexcept {
  const Vector3 lever = state.pose.rotation * measured.model_m;
  const SecondOrder beyond =
      second_order(lever, state.covariance.block<3, 3>(k_rotation, k_rotation));
  const Matrix3 cross = cross_matrix(lever);  // dR lever = dtheta x lever = -[lever]x dtheta
  const Gain<3> ph = state.covariance.middleCols<3>(k_position) +
                     state.covariance.middleCols<3>(k_rotation).lazyProduct(cross);
  const Matrix3 s = ph.middleRows<3>(k_position) - cross.lazyProduct(ph.middleRows<3>(k_rotation)) +
                    measured.covariance_m2 + beyond.covariance;
  const Vector3 innovation = measured.measured_m - (state.pose.translation + lever + beyond.mean);
  const Quaternion before = state.pose.rotation;
  Correction correction = correct<3>(state, ph, s, innovation);
  correction.linear_nis = correction.nis;
  if (correction.reason != Reason::none) return correction;
  // One marker correlates position and rotation errors by its lever arm, and its correction may
  // rotate the state far. If the errors did not rotate along, the next frame would seem to observe
  // the rotation about the marker, which is unobservable (an inconsistent filter).
  rotate_errors(state.covariance, (state.pose.rotation * before.conjugate()).toRotationMatrix());
  return correction;
}

Vector6 pose_difference(const Pose& measured, const Pose& predicted) noexcept {
  Vector6 difference;
  difference << measured.translation - predicted.translation,
      rotation_vector(measured.rotation * predicted.rotation.conjugate());
  return difference;
}

MotionState transformed_state(const MotionState& state, const Pose& moved) noexcept {
  MotionState out = state;
  out.pose = {(moved.rotation * state.pose.rotation).normalized(), moved * state.pose.translation};
  for (Vector3* v : {&out.velocity_m_s, &out.acceleration_m_s2, &out.angular_velocity_rad_s,
                     &out.angular_acceleration_rad_s2})
    *v = moved.rotation * *v;
  rotate_errors(out.covariance, moved.rotation.toRotationMatrix());
  return out;
}

UncertainPose pose_of(const MotionState& state) noexcept {
  UncertainPose result{state.time, state.pose, {}};
  const MotionCovariance& p = state.covariance;
  result.covariance << p.block<3, 3>(k_position, k_position), p.block<3, 3>(k_position, k_rotation),
      p.block<3, 3>(k_rotation, k_position), p.block<3, 3>(k_rotation, k_rotation);
  return result;
}

}  // namespace glint
