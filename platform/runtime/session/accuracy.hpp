// Accuracy of tracked poses against the simulator's ground truth: at mid-exposure, in the camera's
// frame.
//
//   trackable  by ground truth alone, at least k_trackable_markers of the tool's markers are
//              visible (platform/sim/visibility.hpp). A frame that is delivered twice counts once.
//              A frame that the tracker rejected or was late for counts too.
//   fresh      the tracker accepted a pose from this frame. tracked_fraction is the share of
//              trackable frames that are fresh.
//   gross      gross.hpp. The number of markers behind a pose has no effect on it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernels/angles.hpp"
#include "nodes/tracker.hpp"
#include "platform/formats/frame_truth.hpp"
#include "platform/runtime/session/gross.hpp"

namespace glint {

inline constexpr int k_trackable_markers = 3;

[[nodiscard]] bool is_trackable(std::uint8_t visible_mask);

// Image position of a marker's blob: x/z and y/z of its centroid's ray.
struct BlobSlopes {
  float x = 0, y = 0;
};

// Result of a frame for one tool. Small, so that the results of a whole run fit into preallocated
// memory.
struct ToolOutcome {
  bool seen = false;  // fresh
  Reason reason = Reason::none;
  std::uint8_t marker_mask = 0;
  Pose T_camera_tool;
  bool present = true;  // false: removed from the tool set; not judged
  double tip_sigma_m = 0;
  std::uint8_t blob_mask = 0;  // the pose's markers that have an entry in `blobs`; 0: not stated
  std::array<BlobSlopes, k_markers_per_tool_max> blobs{};
};
struct FrameOutcome {
  Reason verdict = Reason::none;  // why the frame itself was rejected
  std::array<ToolOutcome, k_tools_max> tools;
};

[[nodiscard]] TrackingError error_of(const ToolOutcome& outcome, const Tool& tool,
                                     const Pose& T_camera_tool);  // ground truth

struct Accuracy {
  std::int64_t frames = 0;     // delivered
  std::int64_t refused = 0;    // late, duplicate, invalid
  std::int64_t trackable = 0;  // pairs of tool and frame
  std::int64_t tracked = 0;    // of those, fresh
  std::int64_t poses = 0;      // all accepted poses, also of frames that were not trackable
  std::int64_t gross = 0;      // of poses
  double tip_rms_m = 0;
  double tip_max_m = 0;
  double angle_rms_rad = 0;
  std::vector<double> tip_errors_m;  // one for each pose, for histograms
  std::vector<double> angle_errors_rad;
  // Tip of the first tool in the ground truth's world frame, for plots: ground truth and
  // measurement.
  std::vector<Vector3> path_truth_m, path_seen_m;

  [[nodiscard]] double tracked_fraction() const {
    return trackable > 0 ? static_cast<double>(tracked) / static_cast<double>(trackable) : 0.0;
  }
};

// outcomes[i] and ground_truths[i] belong to the i-th frame delivered.
[[nodiscard]] Accuracy evaluate(const std::vector<FrameOutcome>& outcomes,
                                const std::vector<FrameGroundTruth>& ground_truths,
                                const ToolSet& tools);

// `tracker`: the tracker that made the estimates, with its tokens still those of this frame. null:
// another method or an overrun's substitute made them; then covariance and assignment are not
// stated.
[[nodiscard]] FrameOutcome outcome_of(const Estimates& estimates, const Tracker* tracker = nullptr);

}  // namespace glint
