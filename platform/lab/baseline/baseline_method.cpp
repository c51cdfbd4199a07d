#include "platform/lab/baseline/baseline_method.hpp"

#include "platform/runtime/session/release_records.hpp"

namespace glint {
namespace {

// As published: constant velocity from the last two poses, and no covariance.
TrackedTool followed_from(const Track& before, const TimedPose& now, ReferenceFrame base,
                          const Vector3& middle, Duration velocity_gap_max) {
  TrackedTool followed;
  followed.reason = Reason::none;
  followed.is_publishable = true;  // the publication flags no pose as ambiguous
  followed.base = base;
  followed.noise = {0, 0};
  followed.estimate.time = now.time;
  followed.estimate.pose = {now.pose.rotation, now.pose * middle};
  const bool moves =
      before.alive && before.base == base && now.time - before.newest.time <= velocity_gap_max;
  if (!moves) return followed;
  const Pose& then = before.newest.pose;
  const Velocity velocity = velocity_between({before.newest.time, {then.rotation, then * middle}},
                                             {now.time, followed.estimate.pose});
  followed.estimate.velocity_m_s = velocity.linear_m_s;
  followed.estimate.angular_velocity_rad_s = velocity.angular_rad_s;
  return followed;
}

}  // namespace

BaselineMethod::BaselineMethod(const Cell& cell) : tracker_(cell.camera, cell.tools.items[0]) {
  ToolSet set = cell.tools;
  set.count = 1;
  tools_.set(set, 1, 0);
  track_.settings.lost_after = cell.lost_after;
}

const Estimates& BaselineMethod::process(const ArrivedFrame& arrived) {
  const FrameStamp stamp = overrun_stamp(arrived.frame);
  FrameVerdict verdict;
  check_(stamp, verdict);

  FittedTool& fitted = fitted_[0].tools[0];
  fitted = FittedTool{};
  fitted.reason = verdict.reason;
  if (verdict.usable()) {
    const BaselineResult result = tracker_.process(arrived.frame, arrived.head);
    fitted.reason = result.reason;
    fitted.rms_m = result.rms_m;
    fitted.T_camera_tool = result.T_camera_tool;
    // The publication does not identify markers: the mask holds only their number.
    fitted.marker_mask = static_cast<std::uint8_t>((1u << result.marker_count) - 1u);
  }
  last_ = estimates_;
  TrackedTool& followed = followed_[0].items[0];
  followed.reason = fitted.reason;
  if (fitted.reason == Reason::none) {
    const HeadPose& head = arrived.head;
    const Pose pose =
        head.valid ? head.T_world_camera * fitted.T_camera_tool : fitted.T_camera_tool;
    followed = followed_from(last_.tracks[0], {stamp.mid_exposure, pose},
                             head.valid ? ReferenceFrame::world : ReferenceFrame::camera,
                             tools_.value().items[0].middle_m(), track_.settings.velocity_gap_max);
  }
  anchor_.now.head = arrived.head;
  track_(verdict, anchor_, tools_, fitted_, followed_, graph::Previous<Estimates>(last_),
         estimates_);
  return estimates_;
}

}  // namespace glint
