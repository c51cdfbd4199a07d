#include "platform/runtime/session/output_figures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kernels/motion/cholesky.hpp"
#include "kernels/motion/interpolate.hpp"
#include "platform/runtime/session/gross.hpp"

namespace glint {
namespace {

constexpr double k_chi_square_95 = 7.814728;  // 3 degrees of freedom
constexpr double k_error_bin_m = 1e-4;

template <std::size_t N>
void count(std::array<std::uint64_t, N>& bins, double at) {
  ++bins[static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(N - 1)))];
}

bool inside(const Vector3& error, const Matrix3& covariance) {
  const Cholesky<3> factor(covariance);
  return factor.positive && factor.forward(error).squaredNorm() <= k_chi_square_95;
}

// Negative log-likelihood of the error. Returns 0 for a covariance that is not positive definite.
double log_score(const Vector6& error, const Matrix6& covariance) {
  const Cholesky<6> factor(covariance);
  if (!factor.positive) return 0;
  constexpr double k_two_pi = 2 * std::numbers::pi;
  return 0.5 * (6 * std::log(k_two_pi) + factor.forward(error).squaredNorm()) +
         factor.lower.diagonal().array().log().sum();
}

}  // namespace

double quantile(std::span<const std::uint64_t> counts, double share) {
  std::uint64_t all = 0, below = 0;
  for (const std::uint64_t n : counts) all += n;
  const double wanted = share * static_cast<double>(all);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    below += counts[i];
    if (below > 0 && static_cast<double>(below) >= wanted) return static_cast<double>(i) + 0.5;
  }
  return 0;
}

OutputStatistics::OutputStatistics(const Cell& cell, GroundTruthOfTool truth)
    : cell_(cell), truth_(std::move(truth)), gap_(cell.camera.period) {}

int OutputStatistics::rate_of(Duration gap) const {
  const std::int64_t halves =
      2 * gap.nanoseconds / std::max<std::int64_t>(1, cell_.camera.period.nanoseconds);
  return halves < 3 ? 0 : halves < 9 ? 1 : 2;
}

void OutputStatistics::add(const PoseSample& sample, std::optional<Time> newest_frame) {
  if (newest_frame && newest_frame != newest_) {
    if (newest_) {
      gap_ = *newest_frame - *newest_;
      const auto rate = static_cast<std::size_t>(rate_of(gap_));
      ++figures_.gaps[rate];
      figures_.seconds[rate] += gap_.seconds();
    }
    newest_ = newest_frame;
  }
  const Duration since = newest_ ? std::max(gap_, sample.tick - *newest_) : gap_;
  RateStatistics& figures = figures_.tools[sample.tool][static_cast<std::size_t>(rate_of(since))];
  ++figures.ticks;
  figures.measured += sample.state == TrackState::measured ? 1 : 0;
  figures.predicted += sample.state == TrackState::predicted ? 1 : 0;
  if (!sample.has_pose()) return;
  count(figures.ages, sample.age().seconds() * 1e3);
  figures.largest_age_sigma_s = std::max(figures.largest_age_sigma_s, sample.age_sigma_s);
  judge(sample, sample.state == TrackState::measured ? figures.of_measured : figures.of_predicted);
}

// True tip pose in the sample's frame, at the time that the pose is predicted to.
std::optional<Pose> OutputStatistics::true_tip(const PoseSample& sample) const {
  if (!truth_ || sample.frame == ReferenceFrame::camera) return std::nullopt;
  const Time time = sample.tick + cell_.actuation_delay;
  std::optional<Pose> tool = truth_(sample.tool, time);
  if (!tool) return std::nullopt;
  if (sample.frame == ReferenceFrame::robot) {
    Pose T_world_robot = cell_.T_world_robot;
    if (cell_.robot_in_reference) {
      const std::optional<Pose> reference = truth_(cell_.reference, time);
      if (!reference) return std::nullopt;
      T_world_robot = *reference * cell_.T_world_robot;
    }
    tool = T_world_robot.inverse() * *tool;
  }
  tool->translation = *tool * cell_.tools.items[sample.tool].tip_m;
  return tool;
}

void OutputStatistics::judge(const PoseSample& sample, OutputErrors& errors) {
  const std::optional<Pose> truth = true_tip(sample);
  if (!truth) return;
  const Vector3 shift = sample.pose.translation - truth->translation;
  const Vector3 turn = rotation_vector(sample.pose.rotation * truth->rotation.conjugate());
  const Matrix3 of_position = sample.covariance.topLeftCorner<3, 3>();
  const Matrix3 of_rotation = sample.covariance.bottomRightCorner<3, 3>();
  ++errors.count;
  errors.inside_position += inside(shift, of_position) ? 1 : 0;
  errors.inside_rotation += inside(turn, of_rotation) ? 1 : 0;
  errors.gross += is_gross({shift.norm(), turn.norm(), std::sqrt(of_position.trace())}) ? 1 : 0;
  Vector6 error;
  error << shift, turn;
  errors.log_score += log_score(error, sample.covariance);
  errors.square_m2 += shift.squaredNorm();
  errors.square_rad2 += turn.squaredNorm();
  errors.stated_m2 += of_position.trace();
  errors.stated_rad2 += of_rotation.trace();
  const Matrix6 random = sample.covariance - sample.systematic;
  errors.random_m2 += random.topLeftCorner<3, 3>().trace();
  errors.random_rad2 += random.bottomRightCorner<3, 3>().trace();
  errors.largest_m = std::max(errors.largest_m, shift.norm());
  count(errors.histogram, shift.norm() / k_error_bin_m);
}

}  // namespace glint
