#include "platform/tools/verify/verification.hpp"

#include <algorithm>
#include <cmath>

#include "platform/dense.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/calibrate/figure_text.hpp"
#include "platform/tools/report/statistics.hpp"
#include "platform/tools/verify/joint_covariance.hpp"
#include "platform/tools/verify/touched_points.hpp"

namespace glint {
namespace {

constexpr double k_piece_s = 1;       // of the rest
constexpr double k_two_sided = 1.96;  // sigmas at 95 %
constexpr int k_fits_min = 20;        // minimum fits for a verdict from residuals alone

// Generalised least squares of y = X p + e.
struct PointFit {
  Eigen::MatrixXd weight, covariance, gain;  // C^-1; covariance of p; p = gain y
  Eigen::VectorXd points, residual;
  double measured_m2 = 0, stated_m2 = 0;  // sums of squares about the unweighted means

  PointFit(const Eigen::VectorXd& y, const Eigen::MatrixXd& x, const Eigen::MatrixXd& c)
      : weight(inverse_of(c)),
        covariance(inverse_of(x.transpose() * weight * x)),
        gain(covariance * x.transpose() * weight),
        points(gain * y),
        residual(y - x * points) {
    const Eigen::MatrixXd mean = x * inverse_of(x.transpose() * x) * x.transpose();
    measured_m2 = (y - mean * y).squaredNorm();
    stated_m2 = (c - mean * c).trace();
  }
};

Eigen::VectorXd tips_of(std::span<const Touch> touches) {
  Eigen::VectorXd y(3 * static_cast<Eigen::Index>(touches.size()));
  for (std::size_t i = 0; i < touches.size(); ++i)
    y.segment<3>(3 * static_cast<Eigen::Index>(i)) = touches[i].mean.tip_m;
  return y;
}

// Design matrix: the point of each touch.
Eigen::MatrixXd design_of(const std::vector<bool>& is_second, Eigen::Index points) {
  const auto n = static_cast<Eigen::Index>(is_second.size());
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(3 * n, 3 * points);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index point = is_second[static_cast<std::size_t>(i)] ? 1 : 0;
    x.block<3, 3>(3 * i, 3 * point) = Matrix3::Identity();
  }
  return x;
}

Check check_of(const PointFit& fit) {
  const auto touches = static_cast<double>(fit.residual.size()) / 3;
  const auto degrees_of_freedom = static_cast<int>(fit.residual.size() - fit.points.size());
  return {std::sqrt(fit.measured_m2 / touches), std::sqrt(fit.stated_m2 / touches),
          chi_square_tail(fit.residual.dot(fit.weight * fit.residual), degrees_of_freedom)};
}

// Distance of the two points, and its derivatives by them.
struct Distance {
  double error_m = 0, sigma_m = 0;
  Eigen::RowVectorXd by_points = Eigen::RowVectorXd(6);

  Distance(const PointFit& fit, const VerifySettings& settings) {
    const Vector3 apart = fit.points.tail<3>() - fit.points.head<3>();
    by_points << -apart.normalized().transpose(), apart.normalized().transpose();
    error_m = apart.norm() - settings.distance_m;
    sigma_m = std::sqrt((by_points * fit.covariance * by_points.transpose())(0) +
                        settings.distance_sigma_m * settings.distance_sigma_m);
  }
};

std::vector<CalibrationFinding> findings_of(const TipSeries& series,
                                            const CalibrationErrors& sums) {
  const ToolErrors errors{series.tool.name.data(), series.tool.marker_count,
                          series.tool.marker_sigma_m, sums};
  return calibration_findings({&errors, 1}, series.stated.camera);
}

// Estimates the calibration errors beside the points; `changing`: covariance of all other errors.
CalibrationErrors errors_of(const TouchedPoints& touched, const Eigen::MatrixXd& changing,
                            const Eigen::MatrixXd& columns, const VerifySettings& settings) {
  const Eigen::VectorXd y = tips_of(touched.touches);
  const Eigen::MatrixXd x = design_of(touched.is_second, 2);
  const PointFit fit(y, x, changing);
  const Distance distance(fit, settings);
  const Eigen::MatrixXd weighed = fit.weight * (columns - x * (fit.gain * columns));
  const Eigen::VectorXd of_distance =
      (distance.by_points * fit.gain * columns).transpose() / distance.sigma_m;
  CalibrationErrors errors;
  errors.information = columns.transpose() * weighed + of_distance * of_distance.transpose();
  errors.information_vector =
      weighed.transpose() * y + of_distance * (distance.error_m / distance.sigma_m);
  errors.fits = static_cast<int>(touched.touches.size());
  for (const Touch& touch : touched.touches) errors.ranges_m += touch.mean.range_m;
  return errors;
}

CalibrationErrors sum_of(CalibrationErrors a, const CalibrationErrors& b) {
  a.information += b.information;
  a.information_vector += b.information_vector;
  a.ranges_m += b.ranges_m;
  a.fits += b.fits;
  return a;
}

void check_points(const TouchedPoints& touched, const TipSeries& series,
                  const VerifySettings& settings, Verification& out) {
  const Eigen::MatrixXd columns = calibration_columns(touched.touches);
  const Eigen::MatrixXd changing =
      joint_covariance(touched.touches, series.stated, TouchPositions::apart);
  const PointFit fit(tips_of(touched.touches), design_of(touched.is_second, 2),
                     changing + columns * columns.transpose());
  out.repeatability = check_of(fit);
  const Distance distance(fit, settings);
  const double sigmas = distance.error_m / distance.sigma_m;
  out.scale = {distance.error_m, distance.sigma_m, chi_square_tail(sigmas * sigmas, 1)};
  out.distance_m = settings.distance_m + distance.error_m;
  out.calibration = findings_of(
      series, sum_of(series.residuals, errors_of(touched, changing, columns, settings)));
  for (const Touch& touch : touched.touches)
    out.range_m += touch.mean.range_m / static_cast<double>(touched.touches.size());
}

Check check_rest(const TipSeries& series, const StaticInterval& interval) {
  const std::vector<Touch> pieces = pieces_of(series, interval, k_piece_s);
  const Eigen::MatrixXd columns = calibration_columns(pieces);
  return check_of(PointFit(tips_of(pieces), design_of(std::vector<bool>(pieces.size(), false), 1),
                           joint_covariance(pieces, series.stated, TouchPositions::same) +
                               columns * columns.transpose()));
}

// Bonferroni: equal significance levels for all checks and all observable calibration errors.
void decide(Verification& out) {
  const std::array<Check*, 3> checks = {&out.repeatability, &out.scale, &out.rest};
  const auto shown = std::count_if(out.calibration.begin(), out.calibration.end(),
                                   [](const CalibrationFinding& one) { return one.axes > 0; });
  out.level =
      (1 - k_confidence) / (static_cast<double>(checks.size()) + static_cast<double>(shown));
  out.agrees = true;
  for (Check* check : checks) {
    check->agrees = check->probability >= out.level;
    out.agrees = out.agrees && check->agrees;
  }
  for (CalibrationFinding& one : out.calibration) {
    one.exceeds_stated = one.axes > 0 && chi_square_tail(one.chi_square, one.axes) < out.level;
    out.agrees = out.agrees && !one.exceeds_stated;
  }
}

}  // namespace

Verification verify_touches(const TipSeries& series, const VerifySettings& settings) {
  const TouchedPoints touched = touched_points(series, settings.distance_m);
  Verification out;
  out.first_touches = touched.first_count;
  out.second_touches = touched.second_count;
  out.other_holds = touched.other_count;
  out.rest_s = touched.static_interval.seconds;
  out.spread_rad = touched.spread.spread_rad;
  out.missing = touched.missing(k_touches_min);
  if (out.missing.empty()) {
    check_points(touched, series, settings, out);
    out.rest = check_rest(series, touched.static_interval);
  } else if (series.residuals.fits >= k_fits_min) {
    out.calibration = findings_of(series, series.residuals);
  }
  decide(out);
  if (!out.missing.empty() && out.agrees) {
    throw InputError(series.what + ": " + out.missing + " (the tool is in " +
                     std::to_string(series.observations.size()) + " of " +
                     std::to_string(series.frames) + " frames)");
  }
  return out;
}

std::vector<std::string> not_covered(const Verification& verification) {
  std::vector<std::string> lines = {
      "an error common to all touches: pose of the world or the robot",
      "a time error or a delay: tool and head are at rest",
      "tracking in motion, at other places and ranges"};
  if (verification.missing.empty()) {
    const double part = k_two_sided * verification.scale.stated_m / verification.distance_m;
    lines.push_back("a scale error below " + format_number("%.2f %%", 100 * part) +
                    ": limited by the distance's standard deviation");
  }
  for (const CalibrationFinding& one : verification.calibration) {
    if (one.axes > 0) continue;
    lines.push_back(std::string(name_of(one.source)) +
                    ": these touches do not reduce its stated sigma");
  }
  return lines;
}

}  // namespace glint
