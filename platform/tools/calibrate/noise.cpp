#include "platform/tools/calibrate/noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/motion/motion_filter.hpp"
#include "kernels/pose/local_rays.hpp"
#include "kernels/pose/weighted_marker.hpp"
#include "platform/dense.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/calibrate/figure_text.hpp"

namespace glint {
namespace {

using Series = std::vector<double>;
using Axes = std::array<Series, k_pose_axes>;
constexpr int k_terms = 3;
using Row = Eigen::Matrix<double, 1, k_terms>;

constexpr int k_times_a_decade = 8;
constexpr double k_static_m = 0.02, k_static_rad = 0.1;  // motion limit of a static tool
constexpr double k_weight_max = 20;  // limit of a row's weight: short times must not dominate

// Window lengths 1, 2, 3, 4, 6, 8, 12 .. poses, as long as four windows fit.
std::vector<int> window_lengths(int poses) {
  std::vector<int> lengths;
  for (int two = 1; 4 * two <= poses; two *= 2) {
    lengths.push_back(two);
    if (two > 1 && 6 * two <= poses) lengths.push_back(3 * two / 2);
  }
  std::sort(lengths.begin(), lengths.end());
  return lengths;
}

double allan_variance(const Series& series, int frames) {
  const auto m = static_cast<std::size_t>(frames);
  Series sums(1, 0.0);
  for (const double value : series) sums.push_back(sums.back() + value);
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i + 2 * m < sums.size(); ++i, ++count) {
    const double difference = (sums[i + 2 * m] - 2 * sums[i + m] + sums[i]) / frames;
    squares += difference * difference;
  }
  return 0.5 * squares / static_cast<double>(count);
}

// Allan variance of a sampled Gauss-Markov process of variance 1.
double markov_variance(double correlation_s, double period_s, int frames) {
  const double keep = std::exp(-period_s / correlation_s), m = frames;
  const double all = 1 - std::pow(keep, m), one = 1 - keep;
  const double of_mean = (m + 2 * keep * (m * one - all) / (one * one)) / (m * m);
  const double between = keep * all * all / (one * one) / (m * m);
  return of_mean - between;
}

Row model_row(const CorrelationTimes& correlation, double period_s, int frames) {
  return {1.0 / frames, markov_variance(correlation.fast_s, period_s, frames),
          markov_variance(correlation.slow_s, period_s, frames)};
}

struct Fit {
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();
  double cost = std::numeric_limits<double>::infinity();
};

// Non-negative least squares by enumeration: the best subset of terms with non-negative solution.
Fit non_negative(const Eigen::Matrix<double, Eigen::Dynamic, k_terms>& rows,
                 const Eigen::VectorXd& measured) {
  Fit best;
  for (int set = 1; set < 1 << k_terms; ++set) {
    Eigen::MatrixXd part(rows.rows(), 0);
    std::vector<int> terms;
    for (int term = 0; term < k_terms; ++term) {
      if (((set >> term) & 1) == 0) continue;
      part.conservativeResize(Eigen::NoChange, part.cols() + 1);
      part.rightCols<1>() = rows.col(term);
      terms.push_back(term);
    }
    const Eigen::VectorXd found = least_squares(part, measured);
    if (!(found.minCoeff() >= 0)) continue;
    const double cost = (part * found - measured).squaredNorm();
    if (!(cost < best.cost)) continue;
    best.cost = cost;
    best.variances.setZero();
    for (std::size_t i = 0; i < terms.size(); ++i)
      best.variances(terms[i]) = found(static_cast<Eigen::Index>(i));
  }
  return best;
}

struct Measured {
  std::vector<int> lengths;
  std::array<Series, k_pose_axes> variances;
  double period_s = 0;
};

// The weight of a row is the square root of its number of independent means.
Fit fit_axis(const Measured& allan, std::size_t axis, int poses, const CorrelationTimes& times) {
  const auto n = static_cast<Eigen::Index>(allan.lengths.size());
  Eigen::Matrix<double, Eigen::Dynamic, k_terms> rows(n, k_terms);
  Eigen::VectorXd ones(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int frames = allan.lengths[static_cast<std::size_t>(i)];
    const double degrees_of_freedom = std::min(static_cast<double>(poses) / frames, k_weight_max);
    const double variance = allan.variances[axis][static_cast<std::size_t>(i)];
    rows.row(i) =
        model_row(times, allan.period_s, frames) * (std::sqrt(degrees_of_freedom) / variance);
    ones(i) = std::sqrt(degrees_of_freedom);
  }
  return non_negative(rows, ones);
}

Axes axes_of(std::span<const TimedPose> poses, const std::string& what) {
  Axes axes;
  const Pose& first = poses.front().pose;
  for (const TimedPose& pose : poses) {
    const Vector6 away = pose_difference(pose.pose, first);
    if (away.head<3>().norm() > k_static_m || away.tail<3>().norm() > k_static_rad) {
      throw InputError(what + ": the tool moved by " + format_mm(away.head<3>().norm()) + " and " +
                       format_number("%.1f deg", away.tail<3>().norm() * k_degrees_per_radian) +
                       "; expected it at rest, or --relative-to the poses of a body beside it");
    }
    for (std::size_t k = 0; k < k_pose_axes; ++k)
      axes[k].push_back(away(static_cast<Eigen::Index>(k)));
  }
  return axes;
}

Measured measure(const Axes& axes, int poses, double period_s, const std::string& what) {
  Measured allan{window_lengths(poses), {}, period_s};
  for (std::size_t k = 0; k < k_pose_axes; ++k) {
    for (const int frames : allan.lengths)
      allan.variances[k].push_back(allan_variance(axes[k], frames));
    if (*std::min_element(allan.variances[k].begin(), allan.variances[k].end()) > 0) continue;
    throw InputError(what + ": all poses are equal; expected a tracker's poses with their noise");
  }
  return allan;
}

}  // namespace

double allan_deviation(const AxisNoise& noise, const CorrelationTimes& correlation, double period_s,
                       int frames) {
  const Eigen::Vector3d variances(noise.white * noise.white, noise.fast * noise.fast,
                                  noise.slow * noise.slow);
  return std::sqrt(model_row(correlation, period_s, frames).dot(variances));
}

NoiseCalibration calibrate_noise(std::span<const TimedPose> poses, const std::string& what) {
  const int count = static_cast<int>(poses.size());
  if (count < k_noise_poses_min) {
    throw InputError(what + ": " + std::to_string(count) + " poses; expected " +
                     std::to_string(k_noise_poses_min) + " or more of a tool at rest");
  }
  NoiseCalibration result;
  result.poses = count;
  result.duration_s = (poses.back().time - poses.front().time).seconds();
  result.period_s = result.duration_s / (count - 1);
  const Measured allan = measure(axes_of(poses, what), count, result.period_s, what);
  const int steps =
      static_cast<int>(std::log10(result.duration_s / result.period_s) * k_times_a_decade);
  const auto time_of = [&](int step) {
    return result.period_s * std::pow(10.0, static_cast<double>(step) / k_times_a_decade);
  };
  double least = std::numeric_limits<double>::infinity();
  for (int fast = 0; fast < steps; ++fast) {
    for (int slow = fast + 1; slow <= steps; ++slow) {
      const CorrelationTimes times{time_of(fast), time_of(slow)};
      std::array<AxisNoise, k_pose_axes> axes;
      double cost = 0;
      for (std::size_t k = 0; k < k_pose_axes; ++k) {
        const Fit fit = fit_axis(allan, k, count, times);
        cost += fit.cost;
        const Eigen::Vector3d sigma = fit.variances.cwiseSqrt();
        axes[k] = {sigma(0), sigma(1), sigma(2)};
      }
      if (!(cost < least)) continue;
      least = cost;
      result.axes = axes;
      result.correlation = times;
    }
  }
  for (std::size_t i = 0; i < allan.lengths.size(); ++i) {
    AllanPoint point{result.period_s * allan.lengths[i], {}, {}};
    for (std::size_t k = 0; k < k_pose_axes; ++k) {
      point.measured[k] = std::sqrt(allan.variances[k][i]);
      point.model[k] =
          allan_deviation(result.axes[k], result.correlation, result.period_s, allan.lengths[i]);
      const double factor = point.model[k] / point.measured[k];
      result.worst_factor = std::max({result.worst_factor, factor, 1 / factor});
    }
    result.allan.push_back(point);
  }
  return result;
}

std::vector<TimedPose> relative_poses(std::span<const TimedPose> poses,
                                      std::span<const TimedPose> other, Duration apart_max) {
  std::vector<TimedPose> relative;
  std::size_t nearest = 0;
  const auto apart = [&](std::size_t i, Time time) {
    return std::abs((other[i].time - time).nanoseconds);
  };
  for (const TimedPose& pose : poses) {
    while (nearest + 1 < other.size() && apart(nearest + 1, pose.time) <= apart(nearest, pose.time))
      ++nearest;
    if (other.empty() || apart(nearest, pose.time) > apart_max.nanoseconds) continue;
    relative.push_back({pose.time, other[nearest].pose.inverse() * pose.pose});
  }
  return relative;
}

CameraUncertainty marker_errors_of(const NoiseCalibration& noise, const Cell& cell,
                                   const Tool& tool, const Pose& T_camera_tool) {
  const Camera& camera = cell.camera;
  std::vector<WeightedMarker> markers;
  std::vector<LocalRays> rays;
  for (int i = 0; i < tool.marker_count; ++i) {
    const Vector3& model = tool.markers_m[static_cast<std::size_t>(i)];
    const Vector3 point = T_camera_tool * model;
    const Result<Vector2> pixel = project(camera.model, point);
    int steps = 0;
    const Result<LocalRays> local =
        pixel ? local_rays(camera.model, pixel.value, k_ray_steps_max, steps)
              : Result<LocalRays>{{}, pixel.reason};
    if (!local) continue;
    const MarkerVariance variance{camera.pixel_sigma_px * camera.pixel_sigma_px, 0,
                                  camera.pixel_sigma_px * camera.pixel_sigma_px,
                                  camera.range_sigma_m * camera.range_sigma_m};
    const Result<WeightedMarker> marker = whiten_marker(model, local.value, point.norm(), variance);
    if (!marker) continue;
    markers.push_back(marker.value);
    rays.push_back(local.value);
  }
  // Pose variances for 1 mm of range error and for 1 px of centroid error; they are linear in both.
  CameraUncertainty range = k_exact_camera, centroid = k_exact_camera;
  range.correlated_range_m = 0.001;
  centroid.correlated_centroid_px = 1;
  const auto diagonal = [&](const CameraUncertainty& one) {
    return Vector6(systematic_covariance(markers, rays, T_camera_tool, tool.middle_m(), one, 0)
                       .value.correlated.sum()
                       .diagonal());
  };
  const Vector6 of_range = diagonal(range), of_centroid = diagonal(centroid);
  Eigen::Matrix<double, Eigen::Dynamic, k_terms> rows(6, k_terms);
  Eigen::VectorXd ones = Eigen::VectorXd::Ones(6);
  double fast = 0, all = 0;
  for (Eigen::Index k = 0; k < 6; ++k) {
    const AxisNoise& axis = noise.axes[static_cast<std::size_t>(k)];
    const double variance = axis.fast * axis.fast + axis.slow * axis.slow;
    if (!(variance > 0)) {  // white noise only: no marker error may act on this axis
      rows.row(k).setZero();
      ones(k) = 0;
      continue;
    }
    rows.row(k) << of_range(k) / variance, of_centroid(k) / variance, 0;
    fast += axis.fast * axis.fast / variance;
    all += 1;
  }
  CameraUncertainty none = camera.uncertainty;
  none.correlated_range_m = none.correlated_centroid_px = 0;
  if (all == 0) return none;
  const Fit fit = non_negative(rows, ones);
  CameraUncertainty errors = camera.uncertainty;
  errors.correlated_range_m = 0.001 * std::sqrt(fit.variances(0));
  errors.correlated_centroid_px = std::sqrt(fit.variances(1));
  errors.fast_share = fast / all;
  return errors;
}

}  // namespace glint
