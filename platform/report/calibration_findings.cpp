#include "platform/report/calibration_findings.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace glint {
namespace {

// Of an error's variance, how much of it the data have to show.
constexpr double k_shown_least = 0.5;
// In stated sigmas: of one error, of the largest of several, and the rms of several.
constexpr double k_one_most = 2.5, k_largest_most = 3.2, k_rms_most = 2;

// The most likely errors and their covariance, in stated sigmas: first those that the tools share,
// then each tool's own.
struct Estimate {
  Eigen::MatrixXd covariance;
  Eigen::VectorXd errors;

  explicit Estimate(std::span<const ToolErrors> tools) {
    Eigen::Index size = k_common_errors;
    for (const ToolErrors& tool : tools) size += 3 * tool.markers;
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(size, size);
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(size);
    Eigen::Index at = k_common_errors;
    constexpr Eigen::Index k_common = k_common_errors;
    for (const ToolErrors& tool : tools) {
      const Eigen::Index own = 3 * tool.markers;
      const ErrorMatrix all = tool.sums.information.selfadjointView<Eigen::Lower>();
      matrix.topLeftCorner(k_common, k_common) += all.topLeftCorner(k_common, k_common);
      matrix.block(at, 0, own, k_common) += all.block(k_common, 0, own, k_common);
      matrix.block(0, at, k_common, own) += all.block(0, k_common, k_common, own);
      matrix.block(at, at, own, own) += all.block(k_common, k_common, own, own);
      pull.head(k_common) += tool.sums.pull.head(k_common);
      pull.segment(at, own) += tool.sums.pull.segment(k_common, own);
      at += own;
    }
    covariance = matrix.llt().solve(Eigen::MatrixXd::Identity(size, size));
    errors = covariance * pull;
  }
  [[nodiscard]] double shown(int error) const { return 1 - covariance(error, error); }
};

// How large the errors first .. first + count are, where the data show them: along the axes of the
// ellipsoid that the data leave.
struct Size {
  int axes = 0;
  double largest = 0, rms = 0, chi_square = 0;

  Size(const Estimate& estimate, int first, int count) {
    const Eigen::MatrixXd shown = Eigen::MatrixXd::Identity(count, count) -
                                  estimate.covariance.block(first, first, count, count);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(shown);
    for (int i = 0; i < count; ++i) {
      const double part = solver.eigenvalues()(i);
      if (part < k_shown_least) continue;
      const double size =
          solver.eigenvectors().col(i).dot(estimate.errors.segment(first, count)) / std::sqrt(part);
      largest = std::max(largest, std::abs(size));
      chi_square += size * size;
      ++axes;
    }
    if (axes > 0) rms = std::sqrt(chi_square / axes);
  }
  [[nodiscard]] bool beyond() const {
    return axes == 1 ? largest > k_one_most : largest > k_largest_most || rms > k_rms_most;
  }
};

class Findings {
 public:
  Findings(std::span<const ToolErrors> tools, const CameraUncertainty& stated)
      : estimate_(tools), stated_(stated) {
    int fits = 0;
    for (const ToolErrors& tool : tools) {
      range_m_ += tool.sums.ranges_m;
      fits += tool.sums.fits;
    }
    range_m_ /= fits;
    if (estimate_.shown(0) > k_shown_least && estimate_.shown(1) > k_shown_least) {
      add_one(ErrorSource::range_offset, 0, stated.range_offset_m);
      add_one(ErrorSource::range_scale, 1, stated.range_scale);
    } else {
      add_range();
    }
    add_principal_point();
    add_one(ErrorSource::focal_length, 4, stated.focal_scale);
    int at = k_common_errors;
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
  // At the mean range.
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

  Estimate estimate_;
  const CameraUncertainty& stated_;
  double range_m_ = 0;
};

}  // namespace

std::string_view name_of(ErrorSource source) {
  constexpr std::array<std::string_view, 6> names{"range offset",          "range scale",
                                                  "range offset or scale", "principal point",
                                                  "focal length",          "tool geometry"};
  return names[static_cast<std::size_t>(source)];
}

ErrorUnit unit_of(ErrorSource source) {
  if (source == ErrorSource::range_scale || source == ErrorSource::focal_length) return {"%", 100};
  return source == ErrorSource::principal_point ? ErrorUnit{"px", 1} : ErrorUnit{"mm", 1e3};
}

std::string text_of(const CalibrationFinding& finding) {
  const ErrorUnit unit = unit_of(finding.source);
  const bool lens =
      finding.source == ErrorSource::principal_point || finding.source == ErrorSource::focal_length;
  const char* const command = lens                                           ? "camera"
                              : finding.source == ErrorSource::tool_geometry ? "tool"
                                                                             : "depth";
  char at[32] = "";
  if (finding.source == ErrorSource::range)
    std::snprintf(at, sizeof at, " at %.0f mm", 1e3 * finding.range_m);
  char text[256];
  std::snprintf(text, sizeof text,
                "%s%s%s %.2f %s%s (sigma %.2f), %.1f times what is stated; glint calibrate %s",
                finding.tool.c_str(), finding.tool.empty() ? "" : ": ",
                std::string(name_of(finding.source)).c_str(), unit.per_base * finding.estimate,
                unit.text, at, unit.per_base * finding.sigma, finding.stated_sigmas, command);
  return text;
}

void CalibrationNotes::set(std::vector<CalibrationFinding> findings) {
  const std::lock_guard lock(one_);
  findings_ = std::move(findings);
}

std::vector<CalibrationFinding> CalibrationNotes::all() const {
  const std::lock_guard lock(one_);
  return findings_;
}

std::vector<CalibrationFinding> calibration_findings(std::span<const ToolErrors> tools,
                                                     const CameraUncertainty& stated) {
  if (tools.empty()) return {};
  return Findings(tools, stated).found;
}

}  // namespace glint
