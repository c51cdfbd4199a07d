#include "platform/tools/calibrate/board_lens.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <utility>

namespace glint {
namespace {

constexpr int k_jackknife_parts = 9;
constexpr std::size_t k_corner_share_inverse =
    3;  // uses a target only if a third of its corners remain

CameraModel model_of(const cv::Mat& matrix, const cv::Mat& distortion, const cv::Size& size,
                     Lens lens) {
  CameraModel model;
  model.lens = lens;
  model.width = size.width;
  model.height = size.height;
  model.fx = matrix.at<double>(0, 0);
  model.fy = matrix.at<double>(1, 1);
  model.cx = matrix.at<double>(0, 2) + 0.5;  // OpenCV places pixel centres at integers
  model.cy = matrix.at<double>(1, 2) + 0.5;
  const int count = lens == Lens::rational ? 8 : 5;
  for (int i = 0; i < count; ++i) {
    model.distortion[static_cast<std::size_t>(i)] = distortion.at<double>(i);
  }
  return model;
}

// Requires an initial guess for a rational lens, whose cost has distant local minima.
TargetLens solve(const TargetCorners& seen, const cv::Size& size, Lens lens,
                 const TargetLens* start) {
  TargetLens solved;
  int flags = cv::CALIB_USE_QR;
  if (start != nullptr) {
    flags |= cv::CALIB_USE_INTRINSIC_GUESS;
    solved.matrix = start->matrix.clone();
    solved.distortion = cv::Mat::zeros(1, 8, CV_64F);
    for (int i = 0; i < static_cast<int>(start->distortion.total()) && i < 8; ++i)
      solved.distortion.at<double>(i) = start->distortion.at<double>(i);
    if (lens == Lens::rational) flags |= cv::CALIB_RATIONAL_MODEL;
    if (lens == Lens::brown) solved.distortion = start->distortion.clone();
  }
  cv::calibrateCamera(seen.target_points_m, seen.corners, size, solved.matrix, solved.distortion,
                      solved.rotations, solved.translations, flags);
  solved.model = model_of(solved.matrix, solved.distortion, size, lens);
  return solved;
}

// Least-squares offset (x, y) and scale of the other lens's pixels against this one's, at the
// detected corners.
Vector3 difference(const CameraModel& lens, const CameraModel& other,
                   const std::vector<std::vector<cv::Point2f>>& seen) {
  Matrix3 normal = Matrix3::Zero();
  Vector3 sums = Vector3::Zero();
  for (const std::vector<cv::Point2f>& corners : seen) {
    for (const cv::Point2f& corner : corners) {
      const Vector2 pixel(corner.x + 0.5, corner.y + 0.5);
      const Result<Vector3> ray = unproject(lens, pixel);
      const Result<Vector2> moved = ray ? project(other, ray.value) : Result<Vector2>{};
      if (!ray || !moved) continue;
      for (int axis = 0; axis < 2; ++axis) {
        Vector3 row = Vector3::Zero();
        row[axis] = 1;
        row[2] = pixel[axis] - (axis == 0 ? lens.cx : lens.cy);
        normal += row * row.transpose();
        sums += row * (moved.value[axis] - pixel[axis]);
      }
    }
  }
  return normal.inverse() * sums;
}

// Limits of the parts: the terciles of the detected corners along one axis.
std::array<float, 2> thirds_of(const std::vector<std::vector<cv::Point2f>>& seen,
                               float cv::Point2f::*axis) {
  std::vector<float> values;
  for (const std::vector<cv::Point2f>& corners : seen)
    for (const cv::Point2f& corner : corners) values.push_back(corner.*axis);
  std::sort(values.begin(), values.end());
  return {values[values.size() / 3], values[2 * values.size() / 3]};
}

}  // namespace

TargetLens solve_lens(const TargetCorners& seen, const cv::Size& size, Lens lens) {
  const TargetLens plain = solve(seen, size, Lens::brown, nullptr);
  return lens == Lens::rational ? solve(seen, size, lens, &plain) : plain;
}

LensSigmas lens_sigmas(const TargetCorners& seen, const cv::Size& size, const TargetLens& all) {
  const std::array<float, 2> right = thirds_of(seen.corners, &cv::Point2f::x),
                             down = thirds_of(seen.corners, &cv::Point2f::y);
  const auto third = [](float value, const std::array<float, 2>& ends) {
    return (value > ends[0] ? 1 : 0) + (value > ends[1] ? 1 : 0);
  };
  std::vector<Vector3> found;
  Vector3 mean = Vector3::Zero();
  for (int part = 0; part < k_jackknife_parts; ++part) {
    TargetCorners rest;
    for (std::size_t i = 0; i < seen.corners.size(); ++i) {
      std::vector<cv::Point2f> corners;
      std::vector<cv::Point3f> board;
      for (std::size_t k = 0; k < seen.corners[i].size(); ++k) {
        const cv::Point2f& corner = seen.corners[i][k];
        if (3 * third(corner.y, down) + third(corner.x, right) == part) continue;
        corners.push_back(corner);
        board.push_back(seen.target_points_m[i][k]);
      }
      if (k_corner_share_inverse * corners.size() < seen.corners[i].size()) continue;
      rest.corners.push_back(std::move(corners));
      rest.target_points_m.push_back(std::move(board));
    }
    // Compares only at the remaining corners: outside them the lens is extrapolated.
    const TargetLens other = solve(rest, size, all.model.lens, &all);
    found.push_back(difference(all.model, other.model, rest.corners));
    mean += found.back() / double{k_jackknife_parts};
  }
  Vector3 squares = Vector3::Zero();
  for (const Vector3& one : found) squares += (one - mean).cwiseAbs2();
  squares *= double{k_jackknife_parts - 1} / double{k_jackknife_parts};
  return {std::sqrt(0.5 * (squares[0] + squares[1])), std::sqrt(squares[2])};
}

}  // namespace glint
