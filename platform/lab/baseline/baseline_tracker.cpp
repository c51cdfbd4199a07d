#include "platform/lab/baseline/baseline_tracker.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr double k_rim_px = 1.5;  // beyond the bright pixels: a saturated centre has no depth

}  // namespace

BaselineTracker::BaselineTracker(const Camera& camera, const Tool& tool,
                                 const BaselineSettings& settings)
    : camera_(camera), tool_(tool), settings_(settings), front_end_(camera, settings) {}

BaselineResult BaselineTracker::process(const Frame& frame, const HeadPose& head) {
  BaselineResult result;
  if (frame.width() != camera_.model.width || frame.height() != camera_.model.height ||
      frame.depth.empty()) {
    result.reason = Reason::frame_invalid;
    return result;
  }
  if (poses_ > 0 && frame.mid_exposure <= newest_.time) {
    result.reason = Reason::frame_late;
    return result;
  }
  if (settings_.undistortion == BaselineUndistortion::whole_frame) front_end_.undistort(frame);
  const cv::Rect roi = predicted_roi(frame, head);
  result.from_roi = !roi.empty();
  BaselineMatch found;
  if (result.from_roi) {
    search(frame, roi);
    found = match(frame);
  }
  if (found.reason != Reason::none) {
    result.from_roi = false;
    search(frame, front_end_.whole());
    found = match(frame);
  }
  result.reason = found.reason;
  result.T_camera_tool = found.T_camera_tool;
  result.marker_count = found.count;
  result.rms_m = found.rms_m;
  if (found.reason != Reason::none) return result;

  if (head.valid != in_world_) poses_ = 0;
  in_world_ = head.valid;
  previous_ = newest_;
  newest_ = {frame.mid_exposure,
             in_world_ ? head.T_world_camera * found.T_camera_tool : found.T_camera_tool};
  poses_ = std::min(poses_ + 1, 2);
  return result;
}

Result<Pose> BaselineTracker::pose_at(Time time) const {
  if (poses_ == 0) return {{}, Reason::no_frame_yet};
  if (time - newest_.time > settings_.lost_after) return {{}, Reason::too_old};
  if (poses_ == 1) return {newest_.pose};
  return {time < newest_.time ? interpolate(previous_, newest_, time)
                              : extrapolate(previous_, newest_, time, settings_.horizon)};
}

std::span<const BaselineBlob> BaselineTracker::front_end(const Frame& frame) {
  front_end_.undistort(frame);
  front_end_.threshold(front_end_.whole());
  front_end_.halve();
  front_end_.detect();
  return front_end_.blobs();
}

void BaselineTracker::search(const Frame& frame, const cv::Rect& roi) {
  if (settings_.undistortion == BaselineUndistortion::points) {
    front_end_.threshold_raw(frame, roi);
  } else {
    if (settings_.undistortion == BaselineUndistortion::roi) front_end_.undistort_roi(frame, roi);
    front_end_.threshold(roi);
  }
  front_end_.halve();
  front_end_.detect();
  if (settings_.undistortion == BaselineUndistortion::points) front_end_.undistort_blobs();
}

// m = (Z x / f, Z y / f, Z); the sphere's centre is a radius further along the ray.
BaselineMatch BaselineTracker::match(const Frame& frame) {
  points_m_.clear();
  const CameraModel& model = camera_.model;
  for (const BaselineBlob& blob : front_end_.blobs()) {
    const double depth = blob_depth(frame, blob);
    if (!(depth > 0)) continue;
    const Vector3 towards((blob.centre_px.x() - model.cx) / model.fx,
                          (blob.centre_px.y() - model.cy) / model.fy, 1);
    const double length = towards.norm();
    const double surface_z = camera_.depth.kind == DepthKind::radial ? depth / length : depth;
    points_m_.push_back(towards * (surface_z + tool_.centre_offset_m() / length));
  }
  return match_tool(points_m_, tool_, settings_);
}

cv::Rect BaselineTracker::predicted_roi(const Frame& frame, const HeadPose& head) const {
  if (!settings_.use_roi || poses_ == 0 || in_world_ != head.valid) return {};
  const Result<Pose> predicted = pose_at(frame.mid_exposure);
  if (!predicted) return {};
  const Pose T_camera_tool =
      in_world_ ? head.T_world_camera.inverse() * predicted.value : predicted.value;
  double left = camera_.model.width, top = camera_.model.height, right = 0, bottom = 0;
  for (int i = 0; i < tool_.marker_count; ++i) {
    const Vector3 point = T_camera_tool * tool_.markers_m[static_cast<std::size_t>(i)];
    if (!(point.z() > camera_.range_min_m / 2)) return {};
    const double x = camera_.model.fx * point.x() / point.z() + camera_.model.cx;
    const double y = camera_.model.fy * point.y() / point.z() + camera_.model.cy;
    const double reach =
        settings_.roi_margin_px + camera_.model.fx * tool_.marker_radius_m / point.z();
    left = std::min(left, x - reach);
    top = std::min(top, y - reach);
    right = std::max(right, x + reach);
    bottom = std::max(bottom, y + reach);
  }
  left = std::clamp(left, 0.0, static_cast<double>(camera_.model.width));
  top = std::clamp(top, 0.0, static_cast<double>(camera_.model.height));
  right = std::clamp(right, left, static_cast<double>(camera_.model.width));
  bottom = std::clamp(bottom, top, static_cast<double>(camera_.model.height));
  // Even corners and sizes keep the grid of the half-size image.
  const int x0 = static_cast<int>(left) & ~1, y0 = static_cast<int>(top) & ~1;
  const int x1 = std::min((static_cast<int>(right) + 2) & ~1, camera_.model.width);
  const int y1 = std::min((static_cast<int>(bottom) + 2) & ~1, camera_.model.height);
  return {x0, y0, std::max(x1 - x0, 0), std::max(y1 - y0, 0)};
}

double BaselineTracker::blob_depth(const Frame& frame, const BaselineBlob& blob) {
  const Vector2 raw = front_end_.raw_pixel(blob.centre_px);
  for (const double radius : {0.5 * blob.radius_px, blob.radius_px, blob.radius_px + k_rim_px}) {
    const double depth = median_depth(frame, raw, radius);
    if (depth > 0) return depth;
  }
  return 0;
}

double BaselineTracker::median_depth(const Frame& frame, const Vector2& raw_px, double radius_px) {
  depths_.clear();
  const int x0 = std::max(0, static_cast<int>(raw_px.x() - radius_px));
  const int y0 = std::max(0, static_cast<int>(raw_px.y() - radius_px));
  const int x1 = std::min(frame.width() - 1, static_cast<int>(raw_px.x() + radius_px));
  const int y1 = std::min(frame.height() - 1, static_cast<int>(raw_px.y() + radius_px));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const std::uint16_t depth = frame.depth.row(y)[x];
      const double off = std::hypot(x + 0.5 - raw_px.x(), y + 0.5 - raw_px.y());
      if (off <= radius_px && depth > 0 && depth < camera_.depth.invalid_from)
        depths_.push_back(depth);
    }
  }
  if (depths_.empty()) return 0;
  const auto middle = depths_.begin() + static_cast<std::ptrdiff_t>(depths_.size() / 2);
  std::nth_element(depths_.begin(), middle, depths_.end());
  return *middle * camera_.depth.unit_m;
}

}  // namespace glint
