// The frame group of a cell, fed frame by frame: what `glint export csv` computes.
#pragma once

#include <memory>
#include <vector>

#include "nodes/tracker.hpp"
#include "platform/apps/python/rows.hpp"
#include "platform/cells/cell.hpp"
#include "platform/runtime/session/frame_pose.hpp"
#include "platform/runtime/session/pipeline.hpp"

namespace glint::python {

class FrameTracker {
 public:
  FrameTracker(const Cell& cell, PoseOrigin origin)
      : tools_(cell.tools), origin_(origin), tracker_(std::make_unique<Tracker>()) {
    configure(cell, *tracker_);
    tracker_->latest<ToolSet>().set(tools_, 1, 0);
  }

  // Returns one row for each tool of the cell. Of a frame that the tracker refuses: state none, and
  // the reason frame_late, frame_duplicate or frame_invalid.
  [[nodiscard]] std::vector<FramePoseRow> track(const Frame& frame, const HeadPose& head) {
    tracker_->input<Frame>() = frame;
    tracker_->input<HeadPose>() = head;
    tracker_->activate();
    const FrameVerdict& verdict = tracker_->output<Estimates>().verdict;
    std::vector<FramePoseRow> rows;
    for (int t = 0; t < tools_.count; ++t) {
      const auto i = static_cast<std::size_t>(t);
      FramePose pose;
      if (verdict.usable()) {
        pose = frame_pose(frame, *tracker_, tools_.items[i], i, origin_);
      } else {
        pose.time = frame.mid_exposure;
        pose.sequence = frame.sequence;
        pose.reason = verdict.reason;
      }
      rows.push_back(row_of(pose, t));
    }
    return rows;
  }

 private:
  [[nodiscard]] static FramePoseRow row_of(const FramePose& pose, int tool) {
    FramePoseRow row{};
    row.time_ns = pose.time.nanoseconds;
    row.sequence = pose.sequence;
    row.tool = static_cast<std::uint8_t>(tool);
    row.state = static_cast<std::uint8_t>(pose.state);
    row.reason = static_cast<std::uint8_t>(pose.reason);
    row.frame = static_cast<std::uint8_t>(pose.frame);
    row.marker_mask = pose.marker_mask;
    row.rms_m = k_nan;
    put_nothing(row.position_m);
    put_nothing(row.orientation_xyzw);
    put_nothing(row.covariance);
    if (pose.state != TrackState::measured) return row;
    row.rms_m = pose.rms_m;
    put(row.position_m, pose.pose.translation);
    put(row.orientation_xyzw, pose.pose.rotation);
    put(row.covariance, pose.covariance);
    return row;
  }

  ToolSet tools_;
  PoseOrigin origin_;
  std::unique_ptr<Tracker> tracker_;
};

}  // namespace glint::python
