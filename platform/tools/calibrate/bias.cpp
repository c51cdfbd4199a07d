#include "platform/tools/calibrate/bias.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "kernels/motion/motion_state.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/calibrate/correlation.hpp"
#include "platform/tools/calibrate/figure_text.hpp"
#include "platform/tools/calibrate/robust.hpp"

namespace glint {
namespace {

constexpr double k_speed_window_s = 0.1;  // to both sides
constexpr double k_sigma_min = 1e-9;      // metres and radians: floor for identical samples

Time later(Time time, double seconds) {
  return time + Duration{static_cast<std::int64_t>(std::llround(1e9 * seconds))};
}

// Interpolates the reference between the two samples around the time; empty in a gap or outside.
std::optional<Pose> at(std::span<const TimedPose> reference, Time time, double gap_max_s) {
  const auto after =
      std::lower_bound(reference.begin(), reference.end(), time,
                       [](const TimedPose& sample, Time t) { return sample.time < t; });
  if (after == reference.end()) return std::nullopt;
  if (after->time == time) return after->pose;
  if (after == reference.begin()) return std::nullopt;
  const TimedPose& before = *(after - 1);
  if ((after->time - before.time).seconds() > gap_max_s) return std::nullopt;
  return interpolate(before, *after, time);
}

struct Sample {
  Pose measured, truth;
};

// Correction of the measured pose: translation, then rotation, along the frame's axes.
Vector6 error_of(const Sample& sample, CorrectionFrame frame) {
  Vector6 error;
  if (frame == CorrectionFrame::tool) {
    const Pose off = sample.measured.inverse() * sample.truth;
    error << off.translation, rotation_vector(off.rotation);
  } else {
    error << sample.truth.translation - sample.measured.translation,
        rotation_vector(sample.truth.rotation * sample.measured.rotation.conjugate());
  }
  return error;
}

std::vector<Sample> static_samples(std::span<const TimedPose> poses,
                                   std::span<const TimedPose> reference,
                                   const BiasSettings& settings, int& moving) {
  std::vector<Sample> samples;
  for (const TimedPose& pose : poses) {
    const auto truth = at(reference, pose.time, settings.gap_max_s);
    const auto before = at(reference, later(pose.time, -k_speed_window_s), settings.gap_max_s);
    const auto after = at(reference, later(pose.time, k_speed_window_s), settings.gap_max_s);
    if (!truth || !before || !after) continue;
    const double window_s = 2 * k_speed_window_s;
    const double speed = (after->translation - before->translation).norm() / window_s;
    const double turn =
        rotation_vector(after->rotation * before->rotation.conjugate()).norm() / window_s;
    if (speed > settings.speed_max_m_s || turn > settings.angular_speed_max_rad_s) {
      ++moving;
    } else {
      samples.push_back({pose.pose, *truth});
    }
  }
  return samples;
}

struct RobustCentre {
  Vector6 value = Vector6::Zero(), sigma = Vector6::Zero();
};

RobustCentre robust_centre(const std::vector<Vector6>& errors) {
  RobustCentre centre;
  for (int axis = 0; axis < 6; ++axis) {
    std::vector<double> values;
    for (const Vector6& error : errors) values.push_back(error[axis]);
    centre.value[axis] = median_of(values);
    for (double& value : values) value -= centre.value[axis];
    centre.sigma[axis] = std::max(sigma_of(values), k_sigma_min);
  }
  return centre;
}

// Mean, and its sigma from the spread and the effective number of independent samples.
void set_mean(const std::vector<Vector6>& errors, BiasResult& result) {
  Vector6 mean = Vector6::Zero(), square = Vector6::Zero();
  const auto n = static_cast<double>(errors.size());
  for (const Vector6& error : errors) mean += error / n;
  std::vector<Vector3> shifts, turns;
  for (const Vector6& error : errors) {
    const Vector6 off = error - mean;
    square += off.cwiseProduct(off) / (n - 1);
    shifts.push_back(off.head<3>());
    turns.push_back(off.tail<3>());
  }
  result.variance_inflation = std::max(correlation_factor(shifts), correlation_factor(turns));
  const Vector6 sigma = (square * (result.variance_inflation / n)).cwiseSqrt();
  result.correction.translation_m = mean.head<3>();
  result.correction.rotation_rad = mean.tail<3>();
  result.translation_sigma_m = sigma.head<3>();
  result.rotation_sigma_rad = sigma.tail<3>();
}

void extend(ValidRange& range, double value) {
  range.from = std::min(range.from, value);
  range.to = std::max(range.to, value);
}

ValidRange with_margin(const ValidRange& range, double margin, double limit) {
  return {std::max(0.0, range.from - margin), std::min(limit, range.to + margin)};
}

void take_validity(const std::vector<Sample>& samples, const BiasSettings& settings,
                   BiasResult& result) {
  ValidRange range{1e9, 0}, off_axis{std::numbers::pi, 0}, tilt{std::numbers::pi, 0};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!result.kept[i]) continue;
    const ViewGeometry seen = view_geometry(samples[i].measured);
    extend(range, seen.range_m);
    extend(off_axis, std::acos(std::clamp(seen.off_axis_cosine, -1.0, 1.0)));
    extend(tilt, std::acos(std::clamp(seen.tilt_cosine, -1.0, 1.0)));
  }
  result.correction.range_m = with_margin(range, settings.margin_m, 1e9);
  result.off_axis_rad = with_margin(off_axis, settings.margin_rad, std::numbers::pi);
  result.tilt_rad = with_margin(tilt, settings.margin_rad, std::numbers::pi);
  const auto cosines = [](const ValidRange& angle) {
    return ValidRange{std::cos(angle.to), std::cos(angle.from)};
  };
  result.correction.off_axis_cosine = cosines(result.off_axis_rad);
  result.correction.tilt_cosine = cosines(result.tilt_rad);
}

void take_residuals(const std::vector<Sample>& samples, BiasResult& result) {
  double before = 0, after = 0, turned_before = 0, turned_after = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& sample = samples[i];
    const Pose corrected = correct_bias(result.correction, sample.measured).T_camera_tool;
    const double off = (corrected.translation - sample.truth.translation).norm();
    result.distances_m.push_back(off);
    if (!result.kept[i]) continue;
    after += off * off;
    before += (sample.measured.translation - sample.truth.translation).squaredNorm();
    const auto turned = [&](const Pose& pose) {
      return rotation_vector(pose.rotation * sample.truth.rotation.conjugate()).squaredNorm();
    };
    turned_before += turned(sample.measured);
    turned_after += turned(corrected);
  }
  const double n = std::max(1, result.samples - result.outliers);
  result.rms_before_m = std::sqrt(before / n);
  result.rms_after_m = std::sqrt(after / n);
  result.rms_before_rad = std::sqrt(turned_before / n);
  result.rms_after_rad = std::sqrt(turned_after / n);
}

void check_count(const BiasResult& result, const std::string& what) {
  if (result.samples >= k_bias_samples_min) return;
  if (result.moving > 0) {
    throw InputError(what + ": " + std::to_string(result.samples) + " poses at rest and " +
                     std::to_string(result.moving) + " in motion; expected at least " +
                     std::to_string(k_bias_samples_min) +
                     " at rest: hold camera and tool still, for a second or more at each place");
  }
  throw InputError(what + ": " + std::to_string(result.samples) +
                   " poses lie within the reference's time span; expected at least " +
                   std::to_string(k_bias_samples_min) + " of the same run");
}

void check_mean(const BiasResult& result, const BiasSettings& settings, const std::string& what) {
  if (result.outliers > (1 - settings.inliers_min) * result.samples) {
    throw InputError(what + ": the errors of " + std::to_string(result.outliers) + " of " +
                     std::to_string(result.samples) +
                     " poses at rest differ from the others'; expected at most half: the error is "
                     "not constant along these axes, try --along " +
                     (settings.frame == CorrectionFrame::tool ? "camera" : "tool"));
  }
  const auto largest = [](const Vector3& mean, const Vector3& sigma) {
    return mean.cwiseAbs().cwiseQuotient(sigma.cwiseMax(k_sigma_min)).maxCoeff();
  };
  const double sigmas =
      std::max(largest(result.correction.translation_m, result.translation_sigma_m),
               largest(result.correction.rotation_rad, result.rotation_sigma_rad));
  if (sigmas >= settings.sigmas_min) return;
  throw InputError(what + ": the mean error, " + format_mm(result.correction.translation_m.norm()) +
                   " and " + format_degrees(result.correction.rotation_rad.norm()) + ", is " +
                   format_number("%.2g", sigmas) + " of its sigmas; expected " +
                   format_number("%.2g", settings.sigmas_min) +
                   ": the error is too small to correct, or the run is too short");
}

}  // namespace

BiasResult calibrate_bias(std::span<const TimedPose> poses, std::span<const TimedPose> reference,
                          const BiasSettings& settings, const std::string& what) {
  BiasResult result;
  result.correction.frame = settings.frame;
  const std::vector<Sample> samples = static_samples(poses, reference, settings, result.moving);
  result.samples = static_cast<int>(samples.size());
  check_count(result, what);
  std::vector<Vector6> errors, near;
  for (const Sample& sample : samples) errors.push_back(error_of(sample, settings.frame));
  const RobustCentre centre = robust_centre(errors);
  for (const Vector6& error : errors) {
    const double square = (error - centre.value).cwiseQuotient(centre.sigma).squaredNorm();
    result.kept.push_back(square <= k_chi_square_of_six);
    if (result.kept.back()) near.push_back(error);
  }
  result.outliers = result.samples - static_cast<int>(near.size());
  if (near.size() >= 2) set_mean(near, result);
  check_mean(result, settings, what);
  take_validity(samples, settings, result);
  take_residuals(samples, result);
  return result;
}

}  // namespace glint
