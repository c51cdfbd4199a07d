#include "platform/lab/experiments/baselines.hpp"

#include <cmath>
#include <numbers>

#include "kernels/motion/interpolate.hpp"
#include "kernels/motion/motion_filter.hpp"

namespace glint {
namespace {

class LastValue final : public Predictor {
 public:
  void update(const UncertainPose& measured) override { last_ = measured.pose; }
  [[nodiscard]] Pose predict(Time) const override { return last_; }

 private:
  Pose last_;
};

class LinearSlerp final : public Predictor {
 public:
  void update(const UncertainPose& measured) override {
    before_ = last_;
    last_ = {measured.time, measured.pose};
    if (count_ < 2) ++count_;
  }
  [[nodiscard]] Pose predict(Time time) const override {
    return count_ < 2 ? last_.pose : extrapolate(before_, last_, time, milliseconds(400));
  }

 private:
  TimedPose before_, last_;
  int count_ = 0;
};

double smoothing_factor(double cutoff_hz, double seconds) {
  const double r = 2 * std::numbers::pi * cutoff_hz * seconds;
  return r / (r + 1);
}

class OneEuro final : public Predictor {
 public:
  explicit OneEuro(const PredictorSettings& settings) : settings_(settings) {}
  void update(const UncertainPose& measured) override {
    if (!initialised_) {
      initialised_ = true;
      time_ = measured.time;
      raw_ = pose_ = measured.pose;
      return;
    }
    const double seconds = (measured.time - time_).seconds();
    time_ = measured.time;
    const Vector6 speed = pose_difference(measured.pose, raw_) / seconds;
    raw_ = measured.pose;
    const Vector6 ahead = pose_difference(measured.pose, pose_);
    const auto step = [&](const OneEuroSettings& s, int first) -> Vector3 {
      auto filtered = speed_.segment<3>(first);
      filtered +=
          smoothing_factor(s.speed_cutoff_hz, seconds) * (speed.segment<3>(first) - filtered);
      const double cutoff = s.cutoff_min_hz + s.cutoff_per_speed * filtered.norm();
      return smoothing_factor(cutoff, seconds) * ahead.segment<3>(first);
    };
    pose_.translation += step(settings_.euro_position, 0);
    pose_.rotation =
        (from_rotation_vector(step(settings_.euro_rotation, 3)) * pose_.rotation).normalized();
  }
  [[nodiscard]] Pose predict(Time time) const override {
    const Vector6 ahead = (time - time_).seconds() * speed_;
    return {from_rotation_vector(ahead.tail<3>()) * pose_.rotation,
            pose_.translation + ahead.head<3>()};
  }

 private:
  PredictorSettings settings_;
  bool initialised_ = false;
  Time time_;
  Pose raw_, pose_;
  Vector6 speed_ = Vector6::Zero();
};

// Position and quaternion components, exponentially smoothed twice.
class DoubleExponential final : public Predictor {
 public:
  explicit DoubleExponential(const PredictorSettings& settings) : settings_(settings) {}
  void update(const UncertainPose& measured) override {
    Values value;
    value << measured.pose.translation, measured.pose.rotation.coeffs();
    if (!initialised_) {
      initialised_ = true;
      once_ = twice_ = value;
    } else {
      if (value.tail<4>().dot(once_.tail<4>()) < 0) value.tail<4>() *= -1;
      gap_ = (measured.time - time_).seconds();
      const Values share = shares();
      once_ += share.cwiseProduct(value - once_);
      twice_ += share.cwiseProduct(once_ - twice_);
    }
    time_ = measured.time;
  }
  [[nodiscard]] Pose predict(Time time) const override {
    if (gap_ <= 0) return pose_from(once_);
    const double frames = (time - time_).seconds() / gap_;
    const Values share = shares();
    const Values trend = (share.array() / (1 - share.array()) * (once_ - twice_).array()).matrix();
    return pose_from(2 * once_ - twice_ + frames * trend);
  }

 private:
  using Values = Eigen::Matrix<double, 7, 1>;
  [[nodiscard]] Values shares() const {
    Values share;
    share << Vector3::Constant(settings_.exponential_position),
        Eigen::Vector4d::Constant(settings_.exponential_rotation);
    return share;
  }
  static Pose pose_from(const Values& values) {
    return {Quaternion(Eigen::Vector4d(values.tail<4>())).normalized(), values.head<3>()};
  }

  PredictorSettings settings_;
  bool initialised_ = false;
  Time time_;
  double gap_ = 0;
  Values once_ = Values::Zero(), twice_ = Values::Zero();
};

// Kalman gains of one axis; three axes of equal noise share them.
struct VelocityGains {
  double noise;  // spectral density of the white acceleration
  double pp = 1, pv = 0, vv = 25;

  struct Gain {
    double place, speed;
  };
  Gain step(double seconds, double variance) {
    const double t = seconds;
    pp += t * (2 * pv + t * vv) + noise * t * t * t / 3;
    pv += t * vv + noise * t * t / 2;
    vv += noise * t;
    const Gain gain{pp / (pp + variance), pv / (pp + variance)};
    vv -= gain.speed * pv;
    pv -= gain.place * pv;
    pp -= gain.place * pp;
    return gain;
  }
};

class ConstantVelocity final : public Predictor {
 public:
  explicit ConstantVelocity(const PredictorSettings& settings)
      : linear_{settings.velocity_noise_m2_s3}, angular_{settings.angular_noise_rad2_s3} {}
  void update(const UncertainPose& measured) override {
    const Pose expected = initialised_ ? predict(measured.time) : measured.pose;
    const double seconds = initialised_ ? (measured.time - time_).seconds() : 0;
    initialised_ = true;
    time_ = measured.time;
    const Vector6 ahead = pose_difference(measured.pose, expected);
    const auto a = linear_.step(seconds, measured.covariance.diagonal().head<3>().mean());
    const auto b = angular_.step(seconds, measured.covariance.diagonal().tail<3>().mean());
    pose_.translation = expected.translation + a.place * ahead.head<3>();
    pose_.rotation =
        (from_rotation_vector(b.place * ahead.tail<3>()) * expected.rotation).normalized();
    speed_.head<3>() += a.speed * ahead.head<3>();
    speed_.tail<3>() += b.speed * ahead.tail<3>();
  }
  [[nodiscard]] Pose predict(Time time) const override {
    const Vector6 ahead = (time - time_).seconds() * speed_;
    return {from_rotation_vector(ahead.tail<3>()) * pose_.rotation,
            pose_.translation + ahead.head<3>()};
  }

 private:
  VelocityGains linear_, angular_;
  bool initialised_ = false;
  Time time_;
  Pose pose_;
  Vector6 speed_ = Vector6::Zero();
};

}  // namespace

PredictorPointer make_last_value() { return std::make_unique<LastValue>(); }
PredictorPointer make_linear_slerp() { return std::make_unique<LinearSlerp>(); }
PredictorPointer make_one_euro(const PredictorSettings& settings) {
  return std::make_unique<OneEuro>(settings);
}
PredictorPointer make_double_exponential(const PredictorSettings& settings) {
  return std::make_unique<DoubleExponential>(settings);
}
PredictorPointer make_constant_velocity(const PredictorSettings& settings) {
  return std::make_unique<ConstantVelocity>(settings);
}

}  // namespace glint
