// Front end of the baseline, from a frame to blobs: undistort the whole frame, threshold, halve,
// detect blobs. Implemented with OpenCV for speed, as the baseline of every comparison: precomputed
// fixed-point maps, 8 bits throughout, one pass of the blob detector, reused buffers.
//
// Source: Puljiz et al., Inside-out Infrared Marker Tracking via Head Mounted Displays for Smart
//         Robot Programming, section III: cv::undistort, threshold 250, half size, blob detection.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <span>
#include <vector>

#include "kernels/image/frame.hpp"
#include "platform/formats/camera.hpp"
#include "platform/lab/baseline/baseline_settings.hpp"

namespace glint {

struct BaselineBlob {
  Vector2 centre_px;     // undistorted frame, pixel centres at integer + 0.5
  double radius_px = 0;  // full-size pixels
};

class BaselineFrontEnd {
 public:
  BaselineFrontEnd(const Camera& camera, const BaselineSettings& settings);

  // The four stages in order; each reads the result of the previous one. `roi` in undistorted
  // pixels.
  void undistort(const Frame& frame);
  void threshold(const cv::Rect& roi);
  void halve();
  void detect();

  // Replaces undistort(): remaps the ROI alone; only the ROI may be searched afterwards.
  void undistort_roi(const Frame& frame, const cv::Rect& roi);
  // Replaces undistort() and threshold(): the raw frame, in the bounding rectangle of the ROI's raw
  // pixels.
  void threshold_raw(const Frame& frame, const cv::Rect& roi);
  // Call after a raw search: converts the blobs' centres to undistorted pixels.
  void undistort_blobs();

  [[nodiscard]] std::span<const BaselineBlob> blobs() const { return blobs_; }
  [[nodiscard]] cv::Rect whole() const { return {0, 0, size_.width, size_.height}; }
  // Returns the raw frame's pixel of an undistorted pixel.
  [[nodiscard]] Vector2 raw_pixel(const Vector2& undistorted) const;

 private:
  [[nodiscard]] cv::Mat raw(const Frame& frame) const;

  CameraModel model_;
  double threshold_16_ = 0;
  cv::Size size_;
  double scale_to_8_bits_ = 1;  // maps the 16-bit threshold to k_baseline_threshold
  cv::Mat map_, map_fraction_;
  cv::Mat eight_bits_, part_, undistorted_, binary_, half_;
  cv::Rect roi_;
  cv::Ptr<cv::SimpleBlobDetector> detector_;
  std::vector<cv::KeyPoint> key_points_;
  std::vector<BaselineBlob> blobs_;
};

}  // namespace glint
