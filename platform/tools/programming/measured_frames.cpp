#include "platform/tools/programming/measured_frames.hpp"

#include <algorithm>
#include <utility>

#include "kernels/pose/lever_arm.hpp"

namespace glint {

MeasuredFrames::MeasuredFrames(std::size_t tool, double stamp_sigma_s,
                               std::function<bool(Time)> wanted)
    : tool_(tool), stamp_sigma_s_(stamp_sigma_s), wanted_(std::move(wanted)) {}

void MeasuredFrames::add(const TrackedFrame& tracked, const RobotFrame& robot) {
  const Estimates& estimates = *tracked.estimates;
  if (tool_ >= static_cast<std::size_t>(std::max(tracked.tools->count, 0)) ||
      !estimates.verdict.usable()) {
    return;
  }
  const auto part = tool_ % k_tool_partitions;
  const FittedTool& found = tracked.fitted[part]->tools[tool_];
  const TrackedTool& followed = tracked.followed[part]->items[tool_ / k_tool_partitions];
  const CorrectedHead& head = tracked.anchor->now;
  restarts_ = restarts_ || estimates.verdict.resynchronised;
  if (head.moved_along) {
    parent_moved_ = head.gap_correction * parent_moved_;
    place_ = head.gap_correction * place_;
  }
  if (head.in_gap) parent_noise_ += inflation_scale_ * head.step_covariance_at(place_);
  if (found.reason != Reason::none || followed.reason != Reason::none || followed.ambiguous) {
    ++frames_without_;
    return;
  }
  const Tool& shape = tracked.tools->items[tool_];
  const Time time = estimates.verdict.stamp.mid_exposure;
  MeasuredFrame drawn;
  drawn.frame.measured = in_base(filter_measurement_of(found, shape, time), head);
  drawn.base = head.head.valid ? ReferenceFrame::world : ReferenceFrame::camera;
  drawn.restarts = restarts_ || found.contradicts_track || drawn.base != base_;
  drawn.frames_without = frames_without_;
  // The process noise between two frames: the factor adapted by the innovation of the later one.
  drawn.frame.noise = followed.motion.noise_scale();
  if (!drawn.restarts) {
    drawn.frame.parent_moved = parent_moved_;
    drawn.frame.parent_noise = parent_noise_;
  }
  const Vector3& place = drawn.frame.measured.pose.translation;
  Matrix6 calibration = found.systematic.calibration;
  if (head.head.valid) {
    drawn.head_covariance = head.shared_at(place);
    calibration = rotated_covariance(calibration, head.head.T_world_camera.rotation);
  }
  drawn.systematic = calibration + in_base(found.systematic.correlated, head).sum();
  const double clock_s = estimates.verdict.stamp.sigma.seconds();
  drawn.stamp_s2 = stamp_sigma_s_ * stamp_sigma_s_ + clock_s * clock_s;
  drawn.has_robot = has_robot_pose(robot, estimates);
  if (drawn.has_robot) drawn.T_base_robot = robot_in_world(robot, estimates);
  drawn.tip = estimates.tips[tool_];

  frames_without_ = 0;
  parent_moved_ = {};
  parent_noise_.setZero();
  base_ = drawn.base;
  place_ = place;
  inflation_scale_ = followed.motion.inflation_scale();
  const bool wanted = !wanted_ || wanted_(time);
  if (wanted) frames_.push_back(drawn);
  restarts_ = !wanted;  // the next one does not follow this one
}

}  // namespace glint
