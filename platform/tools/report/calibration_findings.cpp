#include "platform/tools/report/calibration_findings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "platform/dense.hpp"

namespace glint {
namespace {

// Part of an error's variance that the data must remove.
constexpr double k_variance_reduction_min = 0.5;
// Limits in stated standard deviations: one error, the largest of several, the rms of several.
constexpr double k_single_error_max_sigmas = 2.5, k_largest_error_max_sigmas = 3.2,
                 k_rms_error_max_sigmas = 2;
constexpr int k_observations_min = 30;
constexpr double k_drift_ratio_max = 2;  // ratio to the declared drift, less two standard
                                         // deviations of the observations
// Standard deviation of the log of the drift factor. The drift's random walk scales with the
// headset's own velocity, which has an error.
constexpr double k_drift_model_sigma = 0.4;

// Maximum a posteriori errors and their covariance, in stated standard deviations: first the errors
// common to all tools, then each tool's own.
struct Estimate {
  Eigen::MatrixXd covariance;
  Eigen::VectorXd errors;

  Estimate(std::span<const ToolErrors> tools, const WorldErrorEstimate* world) {
    Eigen::Index size = k_shared_errors;
    for (const ToolErrors& tool : tools) size += 3 * tool.markers;
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(size, size);
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(size);
    constexpr Eigen::Index k_shared = k_shared_errors, k_common = k_common_errors;
    if (world != nullptr) {
      // `world` contains the prior already, so it replaces the identity and the prior counts once.
      const Eigen::MatrixXd both =
          solve_symmetric(world->covariance, Eigen::MatrixXd::Identity(k_shared, k_shared));
      matrix.topLeftCorner(k_shared, k_shared) = both;
      pull.head(k_shared) = both * world->errors;
    }
    Eigen::Index at = k_shared;
    for (const ToolErrors& tool : tools) {
      const Eigen::Index own = 3 * tool.markers;
      const ErrorMatrix all = tool.sums.information.selfadjointView<Eigen::Lower>();
      matrix.topLeftCorner(k_common, k_common) += all.topLeftCorner(k_common, k_common);
      matrix.block(at, 0, own, k_common) += all.block(k_common, 0, own, k_common);
      matrix.block(0, at, k_common, own) += all.block(0, k_common, k_common, own);
      matrix.block(at, at, own, own) += all.block(k_common, k_common, own, own);
      pull.head(k_common) += tool.sums.information_vector.head(k_common);
      pull.segment(at, own) += tool.sums.information_vector.segment(k_common, own);
      at += own;
    }
    covariance = solve_symmetric(matrix, Eigen::MatrixXd::Identity(size, size));
    errors = covariance * pull;
  }
  [[nodiscard]] double variance_reduction(int error) const { return 1 - covariance(error, error); }
};

// Errors that a static body shows, with the maximum-likelihood factor of the headset's drift.
struct StaticBodyErrors {
  bool seen = false;
  WorldErrorEstimate errors;
  double drift = 1, drift_log_sigma = 0;

  explicit StaticBodyErrors(const WorldErrors* all)
      : seen(all != nullptr && all->measurement_count() >= k_observations_min) {
    if (!seen) return;
    constexpr std::size_t k_factors = k_head_noise_factors.size();
    std::array<WorldErrorEstimate, k_factors> each;
    std::size_t best = 0;
    for (std::size_t i = 0; i < k_factors; ++i) {
      each[i] = all->of_factor(i);
      if (each[i].log_likelihood > each[best].log_likelihood) best = i;
    }
    errors = each[best];
    // Maximum of the parabola through the best factor and its neighbours.
    const std::size_t middle = std::clamp<std::size_t>(best, 1, k_factors - 2);
    const double below = each[middle - 1].log_likelihood, here = each[middle].log_likelihood,
                 above = each[middle + 1].log_likelihood;
    const double step = std::log(k_head_noise_factors[middle + 1] / k_head_noise_factors[middle]);
    const double curvature = below - 2 * here + above;
    const double maximum =
        curvature < 0 ? std::clamp(0.5 * (below - above) / curvature, -1.0, 1.0) : 0;
    drift = k_head_noise_factors[middle] * std::exp(step * maximum);
    drift_log_sigma = curvature < 0 ? step / std::sqrt(-curvature) : step;
  }
};

// Size of the errors first .. first + count - 1, along those principal axes of the remaining
// covariance that the data determine.
struct Size {
  int axes = 0;
  double largest = 0, rms = 0, chi_square = 0;

  Size(const Estimate& estimate, int first, int count) {
    const Eigen::MatrixXd variance_reduction =
        Eigen::MatrixXd::Identity(count, count) -
        estimate.covariance.block(first, first, count, count);
    const SymmetricEigen axis = symmetric_eigen(variance_reduction);
    for (int i = 0; i < count; ++i) {
      const double part = axis.values(i);
      if (part < k_variance_reduction_min) continue;
      const double size =
          axis.vectors.col(i).dot(estimate.errors.segment(first, count)) / std::sqrt(part);
      largest = std::max(largest, std::abs(size));
      chi_square += size * size;
      ++axes;
    }
    if (axes > 0) rms = std::sqrt(chi_square / axes);
  }
  [[nodiscard]] bool beyond() const {
    return axes == 1 ? largest > k_single_error_max_sigmas
                     : largest > k_largest_error_max_sigmas || rms > k_rms_error_max_sigmas;
  }
};

// The calibration command that measures the error, or the place where it is stated.
const char* calibration_command_of(ErrorSource source) {
  switch (source) {
    case ErrorSource::principal_point:
    case ErrorSource::focal_length:
      return "glint calibrate camera";
    case ErrorSource::tool_geometry:
      return "glint calibrate tool";
    case ErrorSource::time_offset:
      return "use one clock for the stamps of head poses and frames";
    case ErrorSource::head_drift:
      return "state it in [headset]";
    default:
      return "glint calibrate depth";
  }
}

class Findings {
 public:
  Findings(std::span<const ToolErrors> tools, const CameraUncertainty& stated,
           const WorldErrors* world, double time_sigma_s)
      : world_(world), estimate_(tools, world_.seen ? &world_.errors : nullptr), stated_(stated) {
    int fits = 0;
    for (const ToolErrors& tool : tools) {
      range_m_ += tool.sums.ranges_m;
      fits += tool.sums.fits;
    }
    range_m_ /= fits;
    if (estimate_.variance_reduction(0) > k_variance_reduction_min &&
        estimate_.variance_reduction(1) > k_variance_reduction_min) {
      add_one(ErrorSource::range_offset, 0, stated.range_offset_m);
      add_one(ErrorSource::range_scale, 1, stated.range_scale);
    } else {
      add_range();
    }
    add_principal_point();
    add_one(ErrorSource::focal_length, 4, stated.focal_scale);
    if (world_.seen) {
      add_one(ErrorSource::time_offset, k_common_errors, time_sigma_s);
      const bool wider = world_.drift * std::exp(-2 * world_.drift_log_sigma) > k_drift_ratio_max;
      const double log_sigma = std::hypot(world_.drift_log_sigma, k_drift_model_sigma);
      found.push_back({{},
                       ErrorSource::head_drift,
                       world_.drift,
                       world_.drift * log_sigma,
                       range_m_,
                       world_.drift,
                       world_.drift * world_.drift,
                       1,
                       wider});
    }
    int at = k_shared_errors;
    for (const ToolErrors& tool : tools) {
      add_geometry(tool, at);
      at += 3 * tool.markers;
    }
  }
  std::vector<CalibrationFinding> found;

 private:
  void add(const std::string& tool, ErrorSource source, double value, double sigma,
           const Size& size) {
    found.push_back({tool, source, value, sigma, range_m_, size.axes > 1 ? size.rms : size.largest,
                     size.chi_square, size.axes, size.axes > 0 && size.beyond()});
  }
  void add_one(ErrorSource source, int at, double stated) {
    add({}, source, estimate_.errors(at) * stated, std::sqrt(estimate_.covariance(at, at)) * stated,
        Size(estimate_, at, 1));
  }
  // Combined offset and scale, at the mean range.
  void add_range() {
    const Eigen::Vector2d part(stated_.range_offset_m, stated_.range_scale * range_m_);
    add({}, ErrorSource::range, part.dot(estimate_.errors.head<2>()),
        std::sqrt(part.dot(estimate_.covariance.topLeftCorner<2, 2>() * part)),
        Size(estimate_, 0, 2));
  }
  void add_principal_point() {
    const Eigen::Vector2d variance = estimate_.covariance.diagonal().segment<2>(2);
    add({}, ErrorSource::principal_point,
        stated_.principal_point_px * estimate_.errors.segment<2>(2).norm(),
        stated_.principal_point_px * std::sqrt(variance.sum()), Size(estimate_, 2, 2));
  }
  void add_geometry(const ToolErrors& tool, int at) {
    const int count = 3 * tool.markers;
    const double square = estimate_.errors.segment(at, count).squaredNorm() / tool.markers;
    const double variance = estimate_.covariance.diagonal().segment(at, count).sum() / tool.markers;
    add(tool.tool, ErrorSource::tool_geometry, tool.marker_sigma_m * std::sqrt(square),
        tool.marker_sigma_m * std::sqrt(variance), Size(estimate_, at, count));
  }

  StaticBodyErrors world_;
  Estimate estimate_;
  const CameraUncertainty& stated_;
  double range_m_ = 0;
};

}  // namespace

std::string_view name_of(ErrorSource source) {
  constexpr std::array<std::string_view, 8> names{
      "range offset", "range scale", "range offset or scale", "principal point",
      "focal length", "time offset", "headset drift",         "tool geometry"};
  return names[static_cast<std::size_t>(source)];
}

ErrorUnit unit_of(ErrorSource source) {
  if (source == ErrorSource::range_scale || source == ErrorSource::focal_length) return {"%", 100};
  if (source == ErrorSource::principal_point) return {"px", 1};
  if (source == ErrorSource::time_offset) return {"ms", 1e3};
  return source == ErrorSource::head_drift ? ErrorUnit{"x", 1} : ErrorUnit{"mm", 1e3};
}

std::string text_of(const CalibrationFinding& finding) {
  const ErrorUnit unit = unit_of(finding.source);
  const char* const remedy = calibration_command_of(finding.source);
  char at[32] = "";
  if (finding.source == ErrorSource::range)
    std::snprintf(at, sizeof at, " at %.0f mm", 1e3 * finding.range_m);
  char text[256];
  std::snprintf(text, sizeof text, "%s%s%s %.2f %s%s (sigma %.2f), %.1f times the stated sigma; %s",
                finding.tool.c_str(), finding.tool.empty() ? "" : ": ",
                std::string(name_of(finding.source)).c_str(), unit.per_base * finding.estimate,
                unit.text, at, unit.per_base * finding.sigma, finding.size_in_stated_sigmas,
                remedy);
  return text;
}

void CalibrationFindingsStore::set(std::vector<CalibrationFinding> findings) {
  const std::lock_guard lock(mutex_);
  findings_ = std::move(findings);
}

std::vector<CalibrationFinding> CalibrationFindingsStore::all() const {
  const std::lock_guard lock(mutex_);
  return findings_;
}

std::vector<CalibrationFinding> calibration_findings(std::span<const ToolErrors> tools,
                                                     const CameraUncertainty& stated,
                                                     const WorldErrors* world,
                                                     double time_sigma_s) {
  if (tools.empty()) return {};
  return Findings(tools, stated, world, time_sigma_s).found;
}

}  // namespace glint
