#include "platform/tools/calibrate/align.hpp"

#include <algorithm>
#include <cmath>

#include "platform/dense.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/calibrate/align_refine.hpp"
#include "platform/tools/calibrate/align_start.hpp"
#include "platform/tools/calibrate/figure_text.hpp"
#include "platform/tools/calibrate/robust.hpp"
#include "platform/tools/calibrate/smooth_series.hpp"

namespace glint {
namespace {

constexpr double k_grid_s = 0.01;
constexpr double k_contrast_shift_s = 0.1;
constexpr std::size_t k_start_samples = 200;  // in the grid search
constexpr double k_alignment_sigma_min_m = 1e-6;
constexpr double k_alignment_sigma_min_rad = 1e-6;
constexpr int k_refinements = 3;

std::vector<TimedPose> subsampled(std::span<const TimedPose> poses) {
  std::vector<TimedPose> subset;
  const std::size_t step = poses.size() / k_start_samples + 1;
  for (std::size_t i = 0; i < poses.size(); i += step) subset.push_back(poses[i]);
  return subset;
}

double median_distance(std::span<const AlignSample> samples, const AlignGuess& start) {
  std::vector<double> distances;
  for (const AlignSample& sample : samples) {
    distances.push_back(position_residual(sample, start).norm());
  }
  return median_of(distances);
}

// The offset on the grid with the least median distance.
AlignGuess best_initial_guess(std::span<const TimedPose> poses,
                              std::span<const TimedPose> reference, const AlignSettings& settings,
                              const std::string& what) {
  const std::vector<TimedPose> subset = subsampled(poses);
  const int steps = static_cast<int>(std::ceil(settings.offset_max_s / k_grid_s));
  AlignGuess best;
  double least = -1;
  for (int step = -steps; step <= steps; ++step) {
    const double offset_s = step * k_grid_s;
    const std::vector<AlignSample> samples =
        paired(subset, reference, offset_s, settings.gap_max_s);
    if (samples.size() < static_cast<std::size_t>(k_align_samples_min)) continue;
    const AlignGuess start = closed_form(samples, offset_s, settings.lever_arm);
    const double distance = median_distance(samples, start);
    if (least >= 0 && !(distance < least)) continue;
    least = distance;
    best = start;
  }
  if (least >= 0) return best;
  throw InputError(what + ": fewer than " + std::to_string(k_align_samples_min) +
                   " poses lie within the reference's time span, at any offset up to " +
                   format_number("%.3g s", settings.offset_max_s) +
                   "; expected both series to overlap, or --align-starts");
}

struct Noise {
  double position_m, rotation_rad;
};

Noise noise_of(std::span<const AlignSample> samples, const AlignGuess& start) {
  std::vector<double> position, rotation;
  for (const AlignSample& sample : samples) {
    const Vector3 miss = position_residual(sample, start), turn = rotation_residual(sample, start);
    for (int axis = 0; axis < 3; ++axis) {
      position.push_back(miss[axis]);
      rotation.push_back(turn[axis]);
    }
  }
  return {std::max(sigma_of(position), k_alignment_sigma_min_m),
          std::max(sigma_of(rotation), k_alignment_sigma_min_rad)};
}

double chi_square(const AlignSample& sample, const AlignGuess& start, const Noise& noise) {
  return position_residual(sample, start).squaredNorm() / (noise.position_m * noise.position_m) +
         rotation_residual(sample, start).squaredNorm() / (noise.rotation_rad * noise.rotation_rad);
}

void check_rotations(const AlignResult& result, const AlignSettings& settings,
                     const std::string& what) {
  if (settings.lever_arm == LeverArm::none ||
      result.spread.spread_rad[0] >= settings.spread_min_rad)
    return;
  throw InputError(what + ": the tool's direction " +
                   format_direction(result.spread.directions.col(0)) + " moved by only " +
                   format_degrees(result.spread.spread_rad[0]) +
                   " rms, so the lever arm along it is not observable; expected at least " +
                   format_degrees(settings.spread_min_rad) +
                   ": turn the tool about two axes, or set --no-lever if both report one frame");
}

// Ratio of misfit: smallest median chi-square of series shifted by k_contrast_shift_s, over that of
// the aligned series. A static tool gives 1, independent of the noise estimate.
double offset_contrast(std::span<const TimedPose> poses, std::span<const TimedPose> reference,
                       const AlignGuess& found, const Noise& noise, const AlignSettings& settings) {
  std::vector<double> medians;
  for (const double shift_s : {0.0, -k_contrast_shift_s, k_contrast_shift_s}) {
    const double offset_s = found.offset_s + shift_s;
    const std::vector<AlignSample> samples = paired(poses, reference, offset_s, settings.gap_max_s);
    if (samples.size() < static_cast<std::size_t>(k_align_samples_min)) continue;
    const AlignGuess start =
        shift_s == 0 ? found : closed_form(samples, offset_s, settings.lever_arm);
    std::vector<double> squares;
    for (const AlignSample& sample : samples) squares.push_back(chi_square(sample, start, noise));
    medians.push_back(median_of(squares));
  }
  if (medians.size() < 2) return 0;
  return *std::min_element(medians.begin() + 1, medians.end()) / std::max(medians[0], 1e-12);
}

void check_fit(const AlignResult& result, const AlignSettings& settings, bool determined,
               const std::string& what) {
  if (!determined || result.offset_contrast < settings.offset_contrast_min) {
    throw InputError(
        what + ": the time offset is not observable: shifted by " +
        format_number("%.3g s", k_contrast_shift_s) + " the series fit " +
        format_number("%.3g", result.offset_contrast) + " times worse; expected at least " +
        format_number("%.3g", settings.offset_contrast_min) + ": move the tool to and fro, faster");
  }
  if (result.outliers > (1 - settings.inliers_min) * result.samples) {
    throw InputError(what + ": " + std::to_string(result.outliers) + " of " +
                     std::to_string(result.samples) +
                     " poses do not fit; expected at most half: the same tool in both series");
  }
}

}  // namespace

AlignResult align_series(std::span<const TimedPose> poses, std::span<const TimedPose> reference,
                         const AlignSettings& settings, const std::string& what) {
  AlignResult result;
  result.spread = rotation_spread(poses);
  check_rotations(result, settings, what);
  const std::vector<TimedPose> smooth = smooth_series(reference);
  reference = smooth;
  AlignGuess start = best_initial_guess(poses, reference, settings, what);

  std::vector<AlignSample> samples;
  AlignFit fit;
  for (int round = 0; round < k_refinements; ++round) {
    samples = paired(poses, reference, start.offset_s, settings.gap_max_s);
    const Noise noise = noise_of(samples, start);
    result.kept.clear();
    for (AlignSample& sample : samples) {
      sample.position_sigma_m = noise.position_m;
      sample.rotation_sigma_rad = noise.rotation_rad;
      result.kept.push_back(chi_square(sample, start, noise) <= k_chi_square_of_six);
    }
    fit = round == 0 ? refined_alignment(samples, start, settings.lever_arm, AlignLoss::cauchy)
                     : refined_alignment(kept_of(samples, result.kept), start, settings.lever_arm,
                                         AlignLoss::none);
    start = fit.found;
  }

  double squares = 0, turns = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    result.distances_m.push_back(position_residual(samples[i], start).norm());
    if (!result.kept[i]) continue;
    squares += position_residual(samples[i], start).squaredNorm();
    turns += rotation_residual(samples[i], start).squaredNorm();
  }
  result.samples = static_cast<int>(samples.size());
  result.outliers = static_cast<int>(std::count(result.kept.begin(), result.kept.end(), false));
  const double count = std::max(1, result.samples - result.outliers);
  result.rms_m = std::sqrt(squares / count);
  result.rms_rad = std::sqrt(turns / count);
  result.T_reference_file = start.x;
  result.T_tool_body = start.y;
  result.offset_s = start.offset_s;
  result.rotation_sigma_rad = largest_sigma(fit.covariance.block<3, 3>(0, 0));
  result.position_sigma_m = largest_sigma(fit.covariance.block<3, 3>(3, 3));
  result.lever_sigma_m = largest_sigma(fit.covariance.block<3, 3>(9, 9));
  result.offset_sigma_s = std::sqrt(fit.covariance(12, 12));
  result.offset_contrast =
      offset_contrast(poses, reference, start, noise_of(samples, start), settings);
  check_fit(result, settings, fit.determined, what);
  return result;
}

}  // namespace glint
