#include "platform/lab/baseline/baseline_match.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

namespace glint {
namespace {

cv::Vec3d cv_vector(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

// Rigid fit by SVD (Kabsch): R = U diag(1, 1, det(U V^T)) V^T of the centred cross-covariance.
BaselineMatch fitted(std::span<const Vector3> points_m, const Tool& tool,
                     const BaselineMatch& labels) {
  BaselineMatch match = labels;
  cv::Vec3d mean_model, mean_point;
  for (int i = 0; i < tool.marker_count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (match.point[at] < 0) continue;
    mean_model += cv_vector(tool.markers_m[at]);
    mean_point += cv_vector(points_m[static_cast<std::size_t>(match.point[at])]);
  }
  mean_model *= 1.0 / match.count;
  mean_point *= 1.0 / match.count;
  cv::Matx33d covariance = cv::Matx33d::zeros();
  for (int i = 0; i < tool.marker_count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (match.point[at] < 0) continue;
    const cv::Vec3d point = cv_vector(points_m[static_cast<std::size_t>(match.point[at])]);
    covariance += (point - mean_point) * (cv_vector(tool.markers_m[at]) - mean_model).t();
  }
  cv::Matx31d w;
  cv::Matx33d u, vt;
  cv::SVD::compute(covariance, w, u, vt);
  const cv::Matx33d sign = cv::Matx33d::diag(cv::Vec3d(1, 1, cv::determinant(u * vt) < 0 ? -1 : 1));
  const cv::Matx33d r = u * sign * vt;
  const cv::Vec3d t = mean_point - r * mean_model;
  Matrix3 rotation;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) rotation(row, column) = r(row, column);
  match.T_camera_tool = {Quaternion(rotation).normalized(), Vector3(t[0], t[1], t[2])};
  double square = 0;
  for (int i = 0; i < tool.marker_count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (match.point[at] < 0) continue;
    square += (match.T_camera_tool * tool.markers_m[at] -
               points_m[static_cast<std::size_t>(match.point[at])])
                  .squaredNorm();
  }
  match.rms_m = std::sqrt(square / match.count);
  return match;
}

class Search {
 public:
  Search(std::span<const Vector3> points_m, const Tool& tool, const BaselineSettings& settings)
      : points_(points_m.first(std::min<std::size_t>(points_m.size(), k_baseline_points_max))),
        tool_(tool),
        settings_(settings),
        distance_(points_.size() * points_.size()) {
    for (std::size_t i = 0; i < points_.size(); ++i)
      for (std::size_t j = 0; j < points_.size(); ++j)
        distance_[i * points_.size() + j] = (points_[i] - points_[j]).norm();
    labels_.point.fill(-1);
    best_.rms_m = settings.max_rms_m;
  }

  BaselineMatch run() {
    grow(0);
    if (best_.count == 0) {
      best_.reason = static_cast<int>(points_.size()) < settings_.min_markers
                         ? Reason::too_few_markers
                         : (found_distances_ ? Reason::bad_fit : Reason::no_labeling);
      best_.rms_m = 0;
    }
    best_.hypotheses = hypotheses_;
    return best_;
  }

 private:
  void grow(int marker) {
    const int possible = labels_.count + tool_.marker_count - marker;
    if (possible < std::max(settings_.min_markers, best_.count)) return;
    if (marker == tool_.marker_count) {
      found_distances_ = true;
      const BaselineMatch match = fitted(points_, tool_, labels_);
      const bool better = match.count > best_.count || match.rms_m < best_.rms_m;
      if (better && match.rms_m < settings_.max_rms_m) {
        best_ = match;
        best_.reason = Reason::none;
      }
      return;
    }
    const auto at = static_cast<std::size_t>(marker);
    for (int point = 0; point < static_cast<int>(points_.size()); ++point) {
      if (hypotheses_ == settings_.hypotheses_max) return;
      if (!agrees(marker, point)) continue;
      ++hypotheses_;
      labels_.point[at] = point;
      ++labels_.count;
      grow(marker + 1);
      labels_.point[at] = -1;
      --labels_.count;
    }
    grow(marker + 1);
  }

  [[nodiscard]] bool agrees(int marker, int point) const {
    for (int other = 0; other < marker; ++other) {
      const int taken = labels_.point[static_cast<std::size_t>(other)];
      if (taken < 0) continue;
      if (taken == point) return false;
      const double measured = distance_[static_cast<std::size_t>(taken) * points_.size() +
                                        static_cast<std::size_t>(point)];
      const double expected_m =
          tool_.distance_m[static_cast<std::size_t>(other)][static_cast<std::size_t>(marker)];
      if (!(std::abs(measured - expected_m) < settings_.delta_m)) return false;
    }
    return true;
  }

  std::span<const Vector3> points_;
  const Tool& tool_;
  const BaselineSettings& settings_;
  int hypotheses_ = 0;
  std::vector<double> distance_;
  BaselineMatch labels_, best_;
  bool found_distances_ = false;
};

}  // namespace

BaselineMatch match_tool(std::span<const Vector3> points_m, const Tool& tool,
                         const BaselineSettings& settings) {
  return Search(points_m, tool, settings).run();
}

}  // namespace glint
