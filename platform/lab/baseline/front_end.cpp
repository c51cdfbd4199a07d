#include "platform/lab/baseline/front_end.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace glint {
namespace {

constexpr double k_baseline_threshold = 250;  // of 8 bits, as published
constexpr double k_outside_px = -16;          // position outside every frame: remap writes black

// Pixels of a halved binary image are 0, 1/4, 1/2, 3/4 or 1 of white; those from 1/2 on count. One
// threshold, one pass.
cv::Ptr<cv::SimpleBlobDetector> make_detector(double max_area_px) {
  cv::SimpleBlobDetector::Params params;
  params.minThreshold = 126;
  params.maxThreshold = 127;
  params.thresholdStep = 10;
  params.minRepeatability = 1;
  params.minDistBetweenBlobs = 1;
  params.filterByArea = true;
  params.minArea = 1;
  params.maxArea = static_cast<float>(max_area_px / 4);
  params.filterByColor = true;
  params.blobColor = 255;
  params.filterByCircularity = false;
  params.filterByConvexity = false;
  params.filterByInertia = false;
  return cv::SimpleBlobDetector::create(params);
}

// Matrix view of the frame's pixels, without a copy.
cv::Mat view_of(const void* pixels, const cv::Size& size, int type) {
  return {size, type, const_cast<void*>(pixels)};
}

}  // namespace

BaselineFrontEnd::BaselineFrontEnd(const Camera& camera, const BaselineSettings& settings)
    : model_(camera.model),
      threshold_16_(camera.threshold),
      size_(camera.model.width, camera.model.height),
      undistorted_(size_, CV_8U),
      detector_(make_detector(settings.max_blob_area_px)) {
  if (camera.reflectivity_bits == 16) scale_to_8_bits_ = k_baseline_threshold / camera.threshold;
  cv::Mat x(size_, CV_32F), y(size_, CV_32F);
  for (int row = 0; row < size_.height; ++row) {
    for (int column = 0; column < size_.width; ++column) {
      const Vector3 ray((column + 0.5 - camera.model.cx) / camera.model.fx,
                        (row + 0.5 - camera.model.cy) / camera.model.fy, 1);
      const Result<Vector2> raw = project(camera.model, ray);
      // OpenCV's pixel centres are at integers.
      x.at<float>(row, column) = static_cast<float>(raw ? raw.value.x() - 0.5 : k_outside_px);
      y.at<float>(row, column) = static_cast<float>(raw ? raw.value.y() - 0.5 : k_outside_px);
    }
  }
  cv::convertMaps(x, y, map_, map_fraction_, CV_16SC2);
}

cv::Mat BaselineFrontEnd::raw(const Frame& frame) const {
  return frame.reflectivity_8.empty() ? view_of(frame.reflectivity_16.pixels, size_, CV_16U)
                                      : view_of(frame.reflectivity_8.pixels, size_, CV_8U);
}

void BaselineFrontEnd::undistort(const Frame& frame) {
  cv::Mat source = raw(frame);
  if (source.depth() == CV_16U) {
    // Half the cost of a 16-bit remap, and no loss: the next stage is binary.
    source.convertTo(eight_bits_, CV_8U, scale_to_8_bits_);
    source = eight_bits_;
  }
  cv::remap(source, undistorted_, map_, map_fraction_, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
}

void BaselineFrontEnd::undistort_roi(const Frame& frame, const cv::Rect& roi) {
  const cv::Rect area = roi & whole();
  if (area.empty()) return;
  const cv::Mat source = raw(frame);
  cv::Mat target = undistorted_(area);
  if (source.depth() == CV_8U) {
    cv::remap(source, target, map_(area), map_fraction_(area), cv::INTER_LINEAR,
              cv::BORDER_CONSTANT);
  } else {
    cv::remap(source, part_, map_(area), map_fraction_(area), cv::INTER_LINEAR,
              cv::BORDER_CONSTANT);
    part_.convertTo(target, CV_8U, scale_to_8_bits_);
  }
}

void BaselineFrontEnd::threshold_raw(const Frame& frame, const cv::Rect& roi) {
  // The lens mapping is monotonic enough that the ROI's corners and side midpoints bound its
  // pixels.
  cv::Rect area = whole();
  if (roi != whole()) {
    double left = size_.width, top = size_.height, right = 0, bottom = 0;
    for (const double x : {0.0, 0.5, 1.0}) {
      for (const double y : {0.0, 0.5, 1.0}) {
        const Vector2 at = raw_pixel({roi.x + x * roi.width, roi.y + y * roi.height});
        left = std::min(left, at.x()), right = std::max(right, at.x());
        top = std::min(top, at.y()), bottom = std::max(bottom, at.y());
      }
    }
    const int x0 = static_cast<int>(left) & ~1, y0 = static_cast<int>(top) & ~1;
    area &=
        {x0, y0, (static_cast<int>(right) + 2 - x0) & ~1, (static_cast<int>(bottom) + 2 - y0) & ~1};
  }
  roi_ = area;
  const cv::Mat source = raw(frame);
  if (roi_.empty()) {
    binary_.release();
  } else if (source.depth() == CV_8U) {
    cv::threshold(source(roi_), binary_, k_baseline_threshold, 255, cv::THRESH_BINARY);
  } else {
    cv::compare(source(roi_), threshold_16_, binary_, cv::CMP_GT);
  }
}

void BaselineFrontEnd::undistort_blobs() {
  for (BaselineBlob& blob : blobs_) {
    const Result<Vector3> ray = unproject(model_, blob.centre_px);
    if (!ray || !(ray.value.z() > 0)) continue;
    blob.centre_px = {model_.fx * ray.value.x() / ray.value.z() + model_.cx,
                      model_.fy * ray.value.y() / ray.value.z() + model_.cy};
  }
}

void BaselineFrontEnd::threshold(const cv::Rect& roi) {
  roi_ = roi & whole();
  if (roi_.empty()) {
    binary_.release();
    return;
  }
  cv::threshold(undistorted_(roi_), binary_, k_baseline_threshold, 255, cv::THRESH_BINARY);
}

void BaselineFrontEnd::halve() {
  const cv::Size half((roi_.width + 1) / 2, (roi_.height + 1) / 2);
  if (roi_.width < 2 || roi_.height < 2) {
    half_.release();
  } else {
    cv::resize(binary_, half_, half, 0, 0, cv::INTER_LINEAR);
  }
}

void BaselineFrontEnd::detect() {
  blobs_.clear();
  if (half_.empty()) return;
  detector_->detect(half_, key_points_);
  const double x_scale = static_cast<double>(roi_.width) / half_.cols;
  const double y_scale = static_cast<double>(roi_.height) / half_.rows;
  for (const cv::KeyPoint& point : key_points_) {
    BaselineBlob blob;
    blob.centre_px = {roi_.x + (point.pt.x + 0.5) * x_scale, roi_.y + (point.pt.y + 0.5) * y_scale};
    blob.radius_px = std::max(0.5 * point.size * x_scale, 1.0);
    blobs_.push_back(blob);
  }
}

Vector2 BaselineFrontEnd::raw_pixel(const Vector2& undistorted) const {
  const int x = std::clamp(static_cast<int>(undistorted.x()), 0, size_.width - 1);
  const int y = std::clamp(static_cast<int>(undistorted.y()), 0, size_.height - 1);
  const auto raw = map_.at<cv::Vec2s>(y, x);
  return {raw[0] + 0.5 + undistorted.x() - (x + 0.5), raw[1] + 0.5 + undistorted.y() - (y + 0.5)};
}

}  // namespace glint
