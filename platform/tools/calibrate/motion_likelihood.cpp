#include "platform/tools/calibrate/motion_likelihood.hpp"

#include <Eigen/LU>
#include <cmath>

namespace glint {
namespace {

constexpr double k_log_two_pi = 1.8378770664093453;
constexpr double k_small_angle = 1e-4;

// Left Jacobian of Exp at v. Source: Sola, Deray and Atchuthan 2018, eq. (145).
Matrix3 left_jacobian(const Vector3& v) {
  const double angle = v.norm();
  const Matrix3 cross = cross_matrix(v);
  if (angle < k_small_angle) return Matrix3::Identity() + 0.5 * cross + cross * cross / 6;
  const double square = angle * angle;
  return Matrix3::Identity() + (1 - std::cos(angle)) / square * cross +
         (angle - std::sin(angle)) / (square * angle) * cross * cross;
}

// The right Jacobian is the transpose of the left one: eq. (144).
Matrix3 inverse_right_jacobian(const Vector3& v) { return left_jacobian(v).transpose().inverse(); }

Matrix3 exponential_of(const Vector3& v) { return from_rotation_vector(v).toRotationMatrix(); }

// Kalman filter with derivatives. For a rotation the mean's rotation vector is zero after each
// correction; rotation_ holds the rotation and rotation_by_ its derivatives by the unknowns.
class SensitiveFilter {
 public:
  SensitiveFilter(MotionPart part, const MotionUnknowns& unknowns,
                  const LikelihoodSettings& settings)
      : part_(part), unknowns_(unknowns), settings_(settings), equations_(part) {
    const double sigma =
        is_rotation() ? settings.noise.rotation_sigma_rad : settings.noise.position_sigma_m;
    variance_ = sigma * sigma;
  }

  void start(const Pose& pose) {
    state_ = {};
    rotation_ = pose.rotation;
    rotation_by_.fill(Vector3::Zero());
    if (!is_rotation()) state_.value.mean.head<3>() = pose.translation;
    const double speed =
        is_rotation() ? settings_.start.start_angular_speed_rad_s : settings_.start.start_speed_m_s;
    // As in initial_motion_state(): a rotation's has the stationary variance of a damped one.
    const double acceleration =
        is_rotation()
            ? unknowns_.noise / (2 * unknowns_.damping)
            : initial_motion_state({}, settings_.start).covariance(k_acceleration, k_acceleration);
    state_.value.covariance.diagonal() << Vector3::Constant(variance_),
        Vector3::Constant(speed * speed), Vector3::Constant(acceleration);
    if (!is_rotation()) return;
    state_.by[0].covariance.diagonal().tail<3>().setConstant(acceleration);
    state_.by[1].covariance.diagonal().tail<3>().setConstant(-acceleration);
  }

  [[nodiscard]] bool propagate(double seconds) {
    if (is_rotation()) {
      state_.value.mean.head<3>().setZero();
      for (Moments& by : state_.by) by.mean.head<3>().setZero();
    }
    if (!equations_.propagate(state_, seconds, unknowns_)) return false;
    if (!is_rotation()) return true;
    const Vector3 turn = state_.value.mean.head<3>();
    const Matrix3 rotated = exponential_of(turn), jacobian = left_jacobian(turn);
    rotation_ = (from_rotation_vector(turn) * rotation_).normalized();
    for (std::size_t i = 0; i < rotation_by_.size(); ++i)
      rotation_by_[i] = rotated * rotation_by_[i] + jacobian * state_.by[i].mean.head<3>();
    return true;
  }

  void correct(const Pose& measured, Likelihood& out) {
    const Vector3 innovation = is_rotation()
                                   ? rotation_vector(measured.rotation * rotation_.conjugate())
                                   : Vector3(measured.translation - state_.value.mean.head<3>());
    const Matrix9 p = state_.value.covariance;
    const Matrix3 s = p.topLeftCorner<3, 3>() + variance_ * Matrix3::Identity();
    const Matrix3 inverse = s.inverse();
    const Vector3 weighted = inverse * innovation;
    const Eigen::Matrix<double, 9, 3> gain = p.leftCols<3>() * inverse;
    const Vector9 error = gain * innovation;
    out.log_likelihood -=
        0.5 * (innovation.dot(weighted) + std::log(s.determinant()) + 3 * k_log_two_pi);
    const Vector3 turn = error.head<3>();
    const Matrix3 innovation_by_turn =
        is_rotation() ? inverse_right_jacobian(innovation) : Matrix3(Matrix3::Identity());
    Vector2 score;
    for (std::size_t i = 0; i < state_.by.size(); ++i) {
      Moments& by = state_.by[i];
      const Vector3 mean_by = is_rotation() ? rotation_by_[i] : Vector3(by.mean.head<3>());
      const Vector3 innovation_by = -(innovation_by_turn * mean_by);
      const Matrix3 s_by = by.covariance.topLeftCorner<3, 3>();
      score[static_cast<Eigen::Index>(i)] =
          -0.5 * (2 * weighted.dot(innovation_by) - weighted.dot(s_by * weighted) +
                  (inverse * s_by).trace());
      const Eigen::Matrix<double, 9, 3> gain_by =
          (by.covariance.leftCols<3>() - gain * s_by) * inverse;
      const Vector9 error_by = gain_by * innovation + gain * innovation_by;
      by.mean += error_by;
      by.covariance -= gain_by * p.topRows<3>() + gain * by.covariance.topRows<3>();
      symmetrize(by.covariance);
      if (is_rotation())
        rotation_by_[i] =
            exponential_of(turn) * rotation_by_[i] + left_jacobian(turn) * error_by.head<3>();
    }
    state_.value.mean += error;
    state_.value.covariance -= gain * p.topRows<3>();
    symmetrize(state_.value.covariance);
    if (is_rotation()) rotation_ = (from_rotation_vector(turn) * rotation_).normalized();
    out.gradient += score;
    out.scores.push_back(score);
    ++out.innovations;
  }

 private:
  [[nodiscard]] bool is_rotation() const { return part_ == MotionPart::rotation; }
  static void symmetrize(Matrix9& p) { p = (0.5 * (p + p.transpose())).eval(); }

  MotionPart part_;
  MotionUnknowns unknowns_;
  const LikelihoodSettings& settings_;
  MotionEquations equations_;
  double variance_ = 0;
  SensitiveMoments state_;
  Quaternion rotation_ = Quaternion::Identity();
  std::array<Vector3, k_motion_unknowns> rotation_by_{Vector3::Zero(), Vector3::Zero()};
};

}  // namespace

Likelihood likelihood_of(std::span<const TimedPose> measured, MotionPart part,
                         const MotionUnknowns& unknowns, const LikelihoodSettings& settings) {
  Likelihood out;
  SensitiveFilter filter(part, unknowns, settings);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const double gap_s = i == 0 ? 0 : (measured[i].time - measured[i - 1].time).seconds();
    if (i == 0 || gap_s > settings.gap_max_s) {
      filter.start(measured[i].pose);
      continue;
    }
    if (!filter.propagate(gap_s)) {
      out.integrated = false;
      return out;
    }
    filter.correct(measured[i].pose, out);
  }
  return out;
}

}  // namespace glint
