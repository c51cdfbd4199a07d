#include "platform/tools/calibrate/depth.hpp"

#include <algorithm>
#include <cmath>

#include "platform/input_error.hpp"
#include "platform/tools/calibrate/depth_refine.hpp"
#include "platform/tools/calibrate/figure_text.hpp"

namespace glint {
namespace {

constexpr double k_default_pixel_sigma_px = 0.1;  // for a blob without a declared sigma
constexpr double k_range_sigma_m = 0.003;         // for a blob without a declared sigma
constexpr double k_sample_sigma_min_m = 1e-6;
constexpr double k_low = 0.05, k_high = 0.95;  // quantiles of the data
constexpr int k_rounds = 4;
// The bias has a valid interval of ranges but none of brightness: a tool may have 2000 counts,
// whatever the data show.
constexpr double k_dim_span_min = 0.5;

double quantile(std::vector<double> values, double part) {
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

DepthSample sample_of(const ObservedMarker& seen, const Tool& tool, Brightness brightness) {
  DepthSample sample;
  const LocalRays& rays = seen.blob.rays;
  sample.marker_m = tool.markers_m[static_cast<std::size_t>(seen.marker)];
  sample.ray = rays.ray;
  // Dual basis of (along_x, along_y) in their plane: separates du and dv.
  const double xx = rays.along_x.squaredNorm(), yy = rays.along_y.squaredNorm();
  const double xy = rays.along_x.dot(rays.along_y), area = xx * yy - xy * xy;
  sample.per_x = (yy * rays.along_x - xy * rays.along_y) / area;
  sample.per_y = (xx * rays.along_y - xy * rays.along_x) / area;
  sample.surface_range_m = seen.blob.surface_range_m;
  sample.centre_behind_m = tool.centre_offset_m();
  if (brightness == Brightness::estimated)
    sample.inverse_signal = DepthBias::k_reference_counts / std::max(seen.blob.peak, 1.0);
  const auto or_default = [](double sigma, double otherwise) {
    return sigma > 0 ? sigma : otherwise;
  };
  sample.sigma_x_px = or_default(seen.blob.sigma_x_px, k_default_pixel_sigma_px);
  sample.sigma_y_px = or_default(seen.blob.sigma_y_px, k_default_pixel_sigma_px);
  sample.sigma_range_m = or_default(seen.blob.sigma_range_m, k_range_sigma_m);
  return sample;
}

template <class Call>
void for_each(std::vector<RangedFrame>& frames, const Call& call) {
  for (RangedFrame& frame : frames)
    for (std::size_t i = 0; i < frame.samples.size(); ++i) call(frame, i);
}

Vector3 residual_of(const RangedFrame& frame, std::size_t i, const Vector3& bias) {
  return depth_residual<double>(frame.samples[i], frame.T_camera_tool.rotation,
                                frame.T_camera_tool.translation, bias);
}

// Scales the declared sigmas by the estimated variance of all pixels and of all ranges.
void take_noise(std::vector<RangedFrame>& frames, const DepthFit& fit) {
  const double pixel = std::sqrt(std::max(fit.pixel_variance, 1e-6));
  const double range = std::sqrt(std::max(fit.range_variance, 1e-6));
  for_each(frames, [&](RangedFrame& frame, std::size_t i) {
    frame.samples[i].sigma_x_px *= pixel;
    frame.samples[i].sigma_y_px *= pixel;
    frame.samples[i].sigma_range_m =
        std::max(frame.samples[i].sigma_range_m * range, k_sample_sigma_min_m);
  });
}

void reject_outliers(std::vector<RangedFrame>& frames, const Vector3& bias, double sigmas) {
  for_each(frames, [&](RangedFrame& frame, std::size_t i) {
    frame.kept[i] = residual_of(frame, i, bias).cwiseAbs().maxCoeff() <= sigmas;
  });
}

struct Observations {
  std::vector<double> ranges_m, dimness, peaks;
};

Observations seen_in(std::span<const ToolObservation> observations) {
  Observations seen;
  for (const ToolObservation& observation : observations) {
    for (const ObservedMarker& marker : observation.markers) {
      seen.ranges_m.push_back(marker.blob.surface_range_m);
      seen.peaks.push_back(std::max(marker.blob.peak, 1.0));
      seen.dimness.push_back(DepthBias::k_reference_counts / seen.peaks.back());
    }
  }
  return seen;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
  const auto n = static_cast<double>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ma += a[i] / n;
    mb += b[i] / n;
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
    ab += (a[i] - ma) * (b[i] - mb);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

// Covariance of the bias from the tool's size error, which follows from the markers' position
// errors.
Matrix3 covariance_of_size(const Tool& tool) {
  double spread_m2 = 0;
  for (int i = 0; i < tool.marker_count; ++i)
    spread_m2 += (tool.markers_m[static_cast<std::size_t>(i)] - tool.middle_m()).squaredNorm();
  const Vector3 per_size(DepthBias::k_reference_m, 1, 0);
  return tool.marker_sigma_m * tool.marker_sigma_m / spread_m2 * per_size * per_size.transpose();
}

std::string format_counts(double counts) { return format_number("%.0f", counts); }

void check_span(const DepthCalibration& result, const DepthCalibrationSettings& settings,
                const std::string& what) {
  const double span_m = result.range_to_m - result.range_from_m;
  if (span_m < settings.span_min_m) {
    throw InputError(what + ": ranges from " + format_mm(result.range_from_m) + " to " +
                     format_mm(result.range_to_m) +
                     " only, so mm_per_m is not observable; expected a span " + "of at least " +
                     format_mm(settings.span_min_m) +
                     ": move the tool towards the camera and away, through all ranges of its use");
  }
  if (settings.brightness == Brightness::left_out) return;
  const double ratio = result.peak_to / result.peak_from;
  if (ratio < settings.dim_ratio_min) {
    throw InputError(
        what + ": brightness from " + format_counts(result.peak_from) + " to " +
        format_counts(result.peak_to) + " counts only, so dim_mm is not observable; expected " +
        "the brightest at least " + format_number("%.3g", settings.dim_ratio_min) +
        " times the dimmest: turn the markers away, show dim ones too, or set --no-brightness");
  }
}

// Requires that the effect of each unknown over the data's span is below part_sigma_max_m.
void check_covariance(const DepthCalibration& result, bool determined, double dim_span,
                      const DepthCalibrationSettings& settings, const std::string& what) {
  const double sigma_max_m = settings.part_sigma_max_m;
  const auto sigma = [&](int i) { return std::sqrt(std::max(0.0, result.covariance(i, i))); };
  const double slope_m = sigma(1) * (result.range_to_m - result.range_from_m);
  const double dim_m = sigma(2) * std::max(dim_span, k_dim_span_min);
  const auto open = [&](const char* part, double value, const std::string& how) {
    throw InputError(what + ": " + part + " is not observable: " +
                     (determined
                          ? "its share of a range has a standard deviation of " + format_mm(value)
                          : std::string("the data do not separate it from the others")) +
                     "; expected at most " + format_mm(sigma_max_m) + ": " + how);
  };
  if (settings.brightness == Brightness::estimated && (!determined || dim_m > sigma_max_m)) {
    open("dim_mm", dim_m,
         std::abs(result.range_dim_correlation) > 0.9
             ? "brightness follows range (correlation " +
                   format_number("%.2f", result.range_dim_correlation) +
                   "): show dim markers near and bright ones far, or set --no-brightness"
             : "record for longer, or set --no-brightness");
  }
  if (!determined || slope_m > sigma_max_m)
    open("mm_per_m", slope_m, "record for longer, at all ranges; turn the tool to the camera");
  if (sigma(0) > sigma_max_m) open("offset_mm", sigma(0), "record for longer, at shorter ranges");
}

void check_fit(const DepthCalibration& result, const DepthCalibrationSettings& settings,
               const std::string& what) {
  const bool others = result.outliers > (1 - settings.inliers_min) * result.markers;
  if (!others && result.pixel_sigma_px <= settings.pixel_sigma_max_px &&
      result.range_sigma_m <= settings.range_sigma_max_m)
    return;
  throw InputError(
      what + ": " + std::to_string(result.outliers) + " of " + std::to_string(result.markers) +
      " markers do not fit, the others miss by " + format_number("%.2g px", result.pixel_sigma_px) +
      " and " + format_mm(result.range_sigma_m) + "; expected at most " +
      format_number("%.0f %%", 100 * (1 - settings.inliers_min)) + ", " +
      format_number("%.2g px", settings.pixel_sigma_max_px) + " and " +
      format_mm(settings.range_sigma_max_m) + ": use the tool file and the lens of the recording");
}

}  // namespace

DepthCalibration calibrate_depth(std::span<const ToolObservation> observations, const Tool& tool,
                                 const DepthCalibrationSettings& settings,
                                 const std::string& what) {
  if (observations.size() < static_cast<std::size_t>(k_depth_frames_min)) {
    throw InputError(what + ": the tool \"" + tool.name.data() + "\" in " +
                     std::to_string(observations.size()) + " frames; expected at least " +
                     std::to_string(k_depth_frames_min) + " with 4 of its markers or more");
  }
  DepthCalibration result;
  const Observations seen = seen_in(observations);
  result.frames = static_cast<int>(observations.size());
  result.markers = static_cast<int>(seen.ranges_m.size());
  result.range_from_m = quantile(seen.ranges_m, k_low);
  result.range_to_m = quantile(seen.ranges_m, k_high);
  result.peak_from = quantile(seen.peaks, k_low);
  result.peak_to = quantile(seen.peaks, k_high);
  result.range_dim_correlation = correlation(seen.ranges_m, seen.dimness);
  check_span(result, settings, what);

  std::vector<RangedFrame> frames;
  for (const ToolObservation& observation : observations) {
    RangedFrame frame{observation.pose.pose, {}, {}};
    for (const ObservedMarker& marker : observation.markers)
      frame.samples.push_back(sample_of(marker, tool, settings.brightness));
    frame.kept.assign(frame.samples.size(), true);
    frames.push_back(std::move(frame));
  }
  DepthFit fit;
  for (int round = 0; round < k_rounds; ++round) {
    fit = refined_depth(frames, fit.bias, settings.brightness,
                        round == 0 ? DepthLoss::cauchy : DepthLoss::none);
    if (round + 1 == k_rounds) break;
    take_noise(frames, fit);
    reject_outliers(frames, fit.bias, settings.inlier_sigmas);
  }

  double before = 0, after = 0, pixels = 0, ranges = 0;
  for_each(frames, [&](RangedFrame& frame, std::size_t i) {
    const DepthSample& sample = frame.samples[i];
    const double miss = residual_of(frame, i, fit.bias)[2] * sample.sigma_range_m;
    const double raw = residual_of(frame, i, Vector3::Zero())[2] * sample.sigma_range_m;
    result.residuals_m.push_back(std::abs(miss));
    result.kept.push_back(frame.kept[i]);
    if (!frame.kept[i]) return;
    before += raw * raw;
    after += miss * miss;
    pixels += sample.sigma_x_px * sample.sigma_x_px;
    ranges += sample.sigma_range_m * sample.sigma_range_m;
  });
  result.outliers = static_cast<int>(std::count(result.kept.begin(), result.kept.end(), false));
  const double n = std::max(1, result.markers - result.outliers);
  result.rms_before_m = std::sqrt(before / n);
  result.rms_after_m = std::sqrt(after / n);
  result.pixel_sigma_px = std::sqrt(pixels / n);
  result.range_sigma_m = std::sqrt(ranges / n);
  result.bias = {fit.bias[0], fit.bias[1], fit.bias[2], result.range_from_m, result.range_to_m};
  result.covariance = fit.covariance;
  result.variance_inflation = fit.variance_inflation;
  check_fit(result, settings, what);
  const double dim_span = quantile(seen.dimness, k_high) - quantile(seen.dimness, k_low);
  check_covariance(result, fit.determined, dim_span, settings, what);
  result.covariance += covariance_of_size(tool);
  return result;
}

}  // namespace glint
