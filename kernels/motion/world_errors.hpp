// Which errors of the lens, the clocks and the headset a body shows that stands still in the world.
//
// What:     where the headset and the body's fits put the body is z = e + b + A c + v t: e the
//           headset's error (head_walk.hpp), b where the body truly is, c the errors of the range
//           and the lens (calibration_errors.hpp), t the time by which the head's poses are ahead
//           of the frames, v the body's apparent velocity. A Kalman filter over (e, b, c, t), once
//           for each of several factors of the headset's declared error; the likelihood of what
//           each of them expected decides between the factors.
// Cost:     a call of work(): one update of 18 states by 6 values.
// Worst:    none is worse than another.
// Accuracy: first order in the errors. A sight that none of its errors explains is left out; after
//           some in a row the headset has found another world, and b is unknown again.
// Source:   Bar-Shalom, Li and Kirubarajan 2001, sections 5.2 (the update) and 11.6.2 (models that
//           do not change, compared by their likelihoods).
#pragma once

#include <array>

#include "kernels/motion/head_walk.hpp"
#include "kernels/pose/calibration_errors.hpp"

namespace glint {

// The common errors of calibration_errors.hpp, then t.
inline constexpr int k_shared_errors = k_common_errors + 1;

// Of the headset's declared deviations.
inline constexpr std::array<double, 5> k_walk_factors{0.5, 1, 2, 4, 8};

struct BodySight {
  Pose T_world_body;                     // as the headset and the fit have it
  Matrix6 covariance = Matrix6::Zero();  // of the fit, about the world's axes at the body
  Eigen::Matrix<double, 6, k_shared_errors> by_errors =
      Eigen::Matrix<double, 6, k_shared_errors>::Zero();  // in stated sigmas
  WalkedError walked;                                     // about the body, since the sight before
};

// What one filter found, in stated sigmas.
struct WorldFindings {
  Eigen::Matrix<double, k_shared_errors, 1> errors =
      Eigen::Matrix<double, k_shared_errors, 1>::Zero();
  Eigen::Matrix<double, k_shared_errors, k_shared_errors> covariance =
      Eigen::Matrix<double, k_shared_errors, k_shared_errors>::Identity();
  double log_likelihood = 0;
};

class WorldErrors {
 public:
  // Waits for work(); false: the sight before still does.
  bool add(const BodySight& sight) noexcept GLINT_NONBLOCKING;
  // The next factor's share of the sight that waits, if one does.
  void work() noexcept GLINT_NONBLOCKING;

  [[nodiscard]] int sights() const { return sights_; }  // that all factors have seen
  [[nodiscard]] bool idle() const { return next_ == k_walk_factors.size(); }
  [[nodiscard]] WorldFindings of_factor(std::size_t factor) const;

 private:
  static constexpr int k_states = 12 + k_shared_errors;
  class Filter {
   public:
    Filter();
    void update(const BodySight& sight, double factor) noexcept GLINT_NONBLOCKING;
    [[nodiscard]] WorldFindings shared() const;

   private:
    void forget_place();
    bool known_ = false;
    int refused_ = 0;  // in a row
    Pose T_world_body_;
    Eigen::Matrix<double, k_states, 1> state_ = Eigen::Matrix<double, k_states, 1>::Zero();
    Eigen::Matrix<double, k_states, k_states> covariance_;
    double log_likelihood_ = 0;
  };
  std::array<Filter, k_walk_factors.size()> filters_;
  std::size_t next_ = k_walk_factors.size();
  BodySight waiting_;
  int sights_ = 0;
};

}  // namespace glint
