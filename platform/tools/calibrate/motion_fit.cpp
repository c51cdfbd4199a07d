#include "platform/tools/calibrate/motion_fit.hpp"

#include <ceres/ceres.h>

#include <cmath>

#include "platform/dense.hpp"

namespace glint {
namespace {

constexpr int k_motion_iterations_max = 60;
constexpr double k_log_step_max =
    9.2;                               // of either unknown from the initial guess: a factor of 10^4
constexpr double k_difference = 0.05;  // step in a logarithm for the likelihood's curvature
// Prior of the damping: 1 sigma of its logarithm around the initial guess. If the motion decays
// faster than the sample period, noise and damping are not separable.
constexpr double k_log_damping_sigma = 1.0;
constexpr double k_log_damping_information = 1 / (k_log_damping_sigma * k_log_damping_sigma);
constexpr std::size_t k_block_scores = 25;  // length of a run of scores that may be correlated

MotionUnknowns unknowns_at(const double* logs) { return {std::exp(logs[0]), std::exp(logs[1])}; }

// Negative log posterior per measurement of the logarithms; owned by Ceres.
class Cost final : public ceres::FirstOrderFunction {
 public:
  Cost(const MotionSeries& series, MotionPart part, const MotionUnknowns& start,
       const LikelihoodSettings& settings, const std::function<void()>& evaluated)
      : series_(series), part_(part), start_(start), settings_(settings), evaluated_(evaluated) {}

  [[nodiscard]] int NumParameters() const override { return k_motion_unknowns; }

  bool Evaluate(const double* logs, double* cost, double* gradient) const override {
    if (std::abs(logs[0] - std::log(start_.noise)) > k_log_step_max ||
        std::abs(logs[1] - std::log(start_.damping)) > k_log_step_max)
      return false;
    const Likelihood found = likelihood_of(series_, part_, unknowns_at(logs), settings_);
    if (evaluated_) evaluated_();
    if (!found.integrated || !std::isfinite(found.log_likelihood)) return false;
    const double n = std::max(1, found.innovations);
    const double off = logs[1] - std::log(start_.damping);
    *cost = (0.5 * k_log_damping_information * off * off - found.log_likelihood) / n;
    if (gradient == nullptr) return true;
    gradient[0] = -found.gradient[0] / n;
    gradient[1] = (k_log_damping_information * off - found.gradient[1]) / n;
    return true;
  }

 private:
  const MotionSeries& series_;
  MotionPart part_;
  MotionUnknowns start_;
  const LikelihoodSettings& settings_;
  const std::function<void()>& evaluated_;
};

// H^-1 S H^-1 (sandwich covariance): H the curvature, S the block sums of scores, since the model
// is misspecified for a real hand.
// Source: White 1982, "Maximum likelihood estimation of misspecified models", Econometrica 50(1),
// theorem 3.2.
void estimate_covariance(const MotionSeries& series, MotionPart part,
                         const LikelihoodSettings& settings, const double* logs, MotionFit& fit) {
  Eigen::Matrix2d curvature;
  for (int i = 0; i < k_motion_unknowns; ++i) {
    double above[2] = {logs[0], logs[1]}, below[2] = {logs[0], logs[1]};
    above[i] += k_difference;
    below[i] -= k_difference;
    curvature.col(i) = (likelihood_of(series, part, unknowns_at(below), settings).gradient -
                        likelihood_of(series, part, unknowns_at(above), settings).gradient) /
                       (2 * k_difference);
  }
  curvature = (0.5 * (curvature + curvature.transpose())).eval();
  curvature(1, 1) += k_log_damping_information;
  fit.determined = symmetric_eigen(curvature).values[0] > 0;
  if (!fit.determined) return;
  const Likelihood found = likelihood_of(series, part, fit.unknowns, settings);
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  spread(1, 1) = k_log_damping_information;
  Vector2 sum = Vector2::Zero();
  for (std::size_t i = 0; i < found.scores.size(); ++i) {
    sum += found.scores[i];
    if ((i + 1) % k_block_scores != 0 && i + 1 < found.scores.size()) continue;
    spread += sum * sum.transpose();
    sum.setZero();
  }
  const Eigen::Matrix2d inverse = curvature.inverse();
  fit.covariance = inverse * spread * inverse;
}

}  // namespace

Likelihood likelihood_of(const MotionSeries& series, MotionPart part,
                         const MotionUnknowns& unknowns, const LikelihoodSettings& settings) {
  Likelihood all;
  for (const std::vector<TimedPose>& one : series) {
    const Likelihood found =
        likelihood_of(std::span<const TimedPose>(one), part, unknowns, settings);
    all.log_likelihood += found.log_likelihood;
    all.gradient += found.gradient;
    all.scores.insert(all.scores.end(), found.scores.begin(), found.scores.end());
    all.innovations += found.innovations;
    all.integrated = all.integrated && found.integrated;
  }
  return all;
}

MotionFit maximise_likelihood(const MotionSeries& series, MotionPart part,
                              const MotionUnknowns& start, const LikelihoodSettings& settings,
                              const std::function<void()>& evaluated) {
  double logs[k_motion_unknowns] = {std::log(start.noise), std::log(start.damping)};
  const ceres::GradientProblem problem(new Cost(series, part, start, settings, evaluated));
  ceres::GradientProblemSolver::Options options;
  options.line_search_direction_type = ceres::BFGS;
  options.max_num_iterations = k_motion_iterations_max;
  options.function_tolerance = 1e-7;
  options.gradient_tolerance = 1e-6;
  options.logging_type = ceres::SILENT;
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(options, problem, logs, &summary);
  MotionFit fit;
  if (!summary.IsSolutionUsable()) return fit;
  fit.unknowns = unknowns_at(logs);
  estimate_covariance(series, part, settings, logs, fit);
  return fit;
}

}  // namespace glint
