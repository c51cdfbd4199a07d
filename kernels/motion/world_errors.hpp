// Kalman filter for errors of range, lens, clocks and headset, observed on a static reference body.
//
// What:     the headset and the fits measure the body's pose as z = e + b + A c + v t. e is the
//           headset's error (head_drift.hpp), b the body's true pose, c the errors of range and
//           lens (calibration_errors.hpp). t is the time by which head poses are ahead of the
//           frames, v the body's apparent velocity. One Kalman filter over (e, b, c, t) runs for
//           each of several factors on the headset's declared error; the likelihoods of the
//           innovations decide between the factors.
// Cost:     a call of work(): one update of 18 states by 6 values.
// Worst:    data independent.
// Accuracy: first order in the errors. A measurement that fails the chi-square test is rejected;
//           after k_measurements_rejected_max in a row (the headset has relocalised) b becomes
//           unknown.
// Source:   Bar-Shalom, Li and Kirubarajan 2001, sections 5.2 (the update) and 11.6.2 (static
//           multiple models, compared by their likelihoods).
#pragma once

#include <array>

#include "kernels/motion/head_drift.hpp"
#include "kernels/pose/calibration_errors.hpp"

namespace glint {

// The k_common_errors of calibration_errors.hpp (range, lens), then the time offset t.
inline constexpr int k_shared_errors = k_common_errors + 1;

// Factors on the headset's declared standard deviations.
inline constexpr std::array<double, 5> k_head_noise_factors{0.5, 1, 2, 4, 8};

struct BodyMeasurement {
  Pose T_world_body;                     // as measured by the headset and the fit
  Matrix6 covariance = Matrix6::Zero();  // of the fit, along the world's axes at the body
  Eigen::Matrix<double, 6, k_shared_errors> by_errors =
      Eigen::Matrix<double, 6, k_shared_errors>::Zero();  // per declared standard deviation
  ErrorTransition walked;  // about the body, since the previous measurement
};

// Estimate of one filter, in declared standard deviations.
struct WorldErrorEstimate {
  Eigen::Matrix<double, k_shared_errors, 1> errors =
      Eigen::Matrix<double, k_shared_errors, 1>::Zero();
  Eigen::Matrix<double, k_shared_errors, k_shared_errors> covariance =
      Eigen::Matrix<double, k_shared_errors, k_shared_errors>::Identity();
  double log_likelihood = 0;
};

class WorldErrors {
 public:
  // Stores a measurement for work(). Returns false while the previous one is in process.
  bool add(const BodyMeasurement& sight) noexcept GLINT_NONBLOCKING;
  // Updates the next factor's filter by the stored measurement, if any.
  void work() noexcept GLINT_NONBLOCKING;

  // Measurements processed by all factors.
  [[nodiscard]] int measurement_count() const { return measurement_count_; }
  [[nodiscard]] bool idle() const { return next_ == k_head_noise_factors.size(); }
  [[nodiscard]] WorldErrorEstimate of_factor(std::size_t factor) const;

 private:
  static constexpr int k_states = 12 + k_shared_errors;
  class Filter {
   public:
    Filter();
    void update(const BodyMeasurement& sight, double factor) noexcept GLINT_NONBLOCKING;
    [[nodiscard]] WorldErrorEstimate shared() const;

   private:
    void reset_body_pose();
    bool known_ = false;
    int refused_ = 0;  // consecutive rejections
    Pose T_world_body_;
    Eigen::Matrix<double, k_states, 1> state_ = Eigen::Matrix<double, k_states, 1>::Zero();
    Eigen::Matrix<double, k_states, k_states> covariance_;
    double log_likelihood_ = 0;
  };
  std::array<Filter, k_head_noise_factors.size()> filters_;
  std::size_t next_ = k_head_noise_factors.size();
  BodyMeasurement pending_;
  int measurement_count_ = 0;
};

}  // namespace glint
