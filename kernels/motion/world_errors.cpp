#include "kernels/motion/world_errors.hpp"

#include <algorithm>

#include "kernels/elementary.hpp"
#include "kernels/motion/cholesky.hpp"
#include "kernels/motion/motion_filter.hpp"

namespace glint {
namespace {

// Chi-square quantile, 6 degrees of freedom, significance level 1e-6.
constexpr double k_measurement_chi_square_max = 38.3;
constexpr int k_measurements_rejected_max = 9;
constexpr double k_prior_sigma_m = 1,
                 k_prior_sigma_rad = 1;  // prior about the first measurement, 1 sigma

}  // namespace

bool WorldErrors::add(const BodyMeasurement& sight) noexcept {
  if (!idle()) return false;
  pending_ = sight;
  next_ = 0;
  return true;
}

void WorldErrors::work() noexcept {
  if (idle()) return;
  filters_[next_].update(pending_, k_head_noise_factors[next_]);
  ++next_;
  if (idle()) ++measurement_count_;
}

WorldErrorEstimate WorldErrors::of_factor(std::size_t factor) const {
  return filters_[factor].shared();
}

WorldErrors::Filter::Filter() {
  covariance_.setIdentity();
  covariance_.topLeftCorner<12, 12>().setZero();
  reset_body_pose();
}

void WorldErrors::Filter::reset_body_pose() {
  covariance_.block<6, k_states>(6, 0).setZero();
  covariance_.block<k_states, 6>(0, 6).setZero();
  covariance_.diagonal().segment<3>(6).setConstant(k_prior_sigma_m * k_prior_sigma_m);
  covariance_.diagonal().segment<3>(9).setConstant(k_prior_sigma_rad * k_prior_sigma_rad);
  state_.segment<6>(6).setZero();
  refused_ = 0;
  known_ = false;
}

void WorldErrors::Filter::update(const BodyMeasurement& sight, double factor) noexcept {
  const double kept = sight.walked.kept;
  state_.head<6>() *= kept;
  covariance_.topRows<6>() *= kept;
  covariance_.leftCols<6>() *= kept;
  covariance_.topLeftCorner<6, 6>() += factor * factor * sight.walked.added();
  if (!known_) T_world_body_ = sight.T_world_body;
  known_ = true;

  // z = H (e, b, c, t), H = (1, 1, by_errors).
  constexpr int k_shared_at = 12;
  Eigen::Matrix<double, k_states, 6> gained =
      covariance_.leftCols<6>() + covariance_.middleCols<6>(6);
  gained +=
      covariance_.middleCols<k_shared_errors>(k_shared_at).lazyProduct(sight.by_errors.transpose());
  Matrix6 expected = gained.topRows<6>() + gained.middleRows<6>(6) + sight.covariance;
  expected += sight.by_errors.lazyProduct(gained.middleRows<k_shared_errors>(k_shared_at));
  const Vector6 innovation = pose_difference(sight.T_world_body, T_world_body_) - state_.head<6>() -
                             state_.segment<6>(6) -
                             sight.by_errors * state_.tail<k_shared_errors>();
  const Cholesky<6> root(0.5 * (expected + expected.transpose()));
  if (!root.positive) return;
  const double chi_square = root.squared_length(innovation);
  // A rejected measurement counts with the limit, so it is never likelier than an accepted one.
  log_likelihood_ -= 0.5 * std::min(chi_square, k_measurement_chi_square_max);
  for (int i = 0; i < 6; ++i) log_likelihood_ -= logarithm(root.lower(i, i));
  if (!(chi_square <= k_measurement_chi_square_max)) {
    if (++refused_ >= k_measurements_rejected_max) reset_body_pose();
    return;
  }
  refused_ = 0;
  const Eigen::Matrix<double, k_states, 6> gain = gained.lazyProduct(root.inverse());
  state_ += gain * innovation;
  covariance_ -= gain.lazyProduct(gained.transpose());
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
}

WorldErrorEstimate WorldErrors::Filter::shared() const {
  return {state_.tail<k_shared_errors>(),
          covariance_.bottomRightCorner<k_shared_errors, k_shared_errors>(), log_likelihood_};
}

}  // namespace glint
