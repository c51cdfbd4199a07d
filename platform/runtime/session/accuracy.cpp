#include "platform/runtime/session/accuracy.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

namespace glint {
namespace {

// Vector from a marker to the nearest point of its blob's ray.
Vector3 to_ray(const BlobSlopes& blob, const Vector3& marker_m) {
  const Vector3 ray = Vector3(double{blob.x}, double{blob.y}, 1).normalized();
  return ray * ray.dot(marker_m) - marker_m;
}

// Returns whether a marker is more than its diameter away from its blob's ray. The centroid of a
// partly occluded marker stays on the marker's disc. The centroid of two merged markers of equal
// size is within one radius beside it. A larger offset comes from another reflector's blob.
// Subtracts the mean offset of three or more blobs first, since that is the lens's error.
bool is_misassigned(const ToolOutcome& outcome, const Tool& tool, const Pose& T_camera_tool) {
  std::array<Vector3, k_markers_per_tool_max> shifts;
  Vector3 sum = Vector3::Zero();
  std::size_t count = 0;
  for (std::size_t m = 0; m < outcome.blobs.size(); ++m) {
    if (((outcome.blob_mask >> m) & 1) == 0) continue;
    shifts[count] = to_ray(outcome.blobs[m], T_camera_tool * tool.markers_m[m]);
    sum += shifts[count++];
  }
  const Vector3 common = count >= 3 ? Vector3(sum / static_cast<double>(count)) : Vector3::Zero();
  return std::any_of(shifts.begin(), shifts.begin() + count, [&](const Vector3& shift) {
    return (shift - common).norm() > 2 * tool.marker_radius_m;
  });
}

void state(const Tracker& tracker, int t, const Estimates& estimates, ToolOutcome& outcome) {
  const auto i = static_cast<std::size_t>(t);
  const FittedTool& fitted = tracker.parts<FittedTools>(t % k_tool_partitions).tools[i];
  const Labeling& labeling = labeling_of(tracker.token<Assignment>(), fitted, i);
  const Markers& markers = tracker.token<Markers>();
  const Matrix6 covariance = tip_covariance(estimates.tracks[i], fitted, estimates.tips[i]);
  outcome.tip_sigma_m = std::sqrt(covariance.topLeftCorner<3, 3>().trace());
  for (std::size_t m = 0; m < labeling.marker.size(); ++m) {
    if (((fitted.marker_mask >> m) & 1) == 0) continue;
    const Vector3& ray = markers.items[static_cast<std::size_t>(labeling.marker[m])].ray;
    outcome.blobs[m] = {static_cast<float>(ray.x() / ray.z()),
                        static_cast<float>(ray.y() / ray.z())};
    outcome.blob_mask = static_cast<std::uint8_t>(outcome.blob_mask | (1u << m));
  }
}

}  // namespace

bool is_trackable(std::uint8_t visible_mask) {
  return std::popcount(visible_mask) >= k_trackable_markers;
}

TrackingError error_of(const ToolOutcome& outcome, const Tool& tool, const Pose& T_camera_tool) {
  TrackingError error;
  error.tip_m = (outcome.T_camera_tool * tool.tip_m - T_camera_tool * tool.tip_m).norm();
  error.angle_rad = outcome.T_camera_tool.rotation.angularDistance(T_camera_tool.rotation);
  error.tip_sigma_m = outcome.tip_sigma_m;
  error.misassigned = is_misassigned(outcome, tool, T_camera_tool);
  return error;
}

FrameOutcome outcome_of(const Estimates& estimates, const Tracker* tracker) {
  FrameOutcome outcome;
  outcome.verdict = estimates.verdict.reason;
  for (int t = 0; t < estimates.tool_count; ++t) {
    const Track& track = estimates.tracks[static_cast<std::size_t>(t)];
    ToolOutcome& tool = outcome.tools[static_cast<std::size_t>(t)];
    tool.seen = track.measured_now && estimates.verdict.usable();
    tool.reason = track.reason;
    tool.marker_mask = track.marker_mask;
    tool.T_camera_tool = track.T_camera_tool;
    tool.present = track.identity != 0;
    if (tool.seen && tracker != nullptr) state(*tracker, t, estimates, tool);
  }
  return outcome;
}

Accuracy evaluate(const std::vector<FrameOutcome>& outcomes,
                  const std::vector<FrameGroundTruth>& ground_truths, const ToolSet& tools) {
  Accuracy result;
  double tip_sum = 0, angle_sum = 0;
  std::set<std::int64_t> exposed;
  std::array<bool, k_tools_max> present;
  present.fill(true);
  const std::size_t count = std::min(outcomes.size(), ground_truths.size());
  result.frames = static_cast<std::int64_t>(count);
  for (std::size_t f = 0; f < count; ++f) {
    const FrameOutcome& outcome = outcomes[f];
    const FrameGroundTruth& truth = ground_truths[f];
    const bool overrun = is_overrun(outcome.verdict);
    result.refused += outcome.verdict != Reason::none && !overrun ? 1 : 0;
    if (!exposed.insert(truth.mid_exposure.nanoseconds).second) continue;
    for (int t = 0; t < tools.count; ++t) {
      const auto i = static_cast<std::size_t>(t);
      const ToolOutcome& tool = outcome.tools[i];
      if (!overrun) present[i] = tool.present;  // an overrun's substitute does not state it
      if (!present[i]) continue;
      if (is_trackable(truth.visible_mask[i])) {
        ++result.trackable;
        result.tracked += tool.seen ? 1 : 0;
      }
      if (!tool.seen) continue;

      const TrackingError error =
          error_of(tool, tools.items[i], truth.T_world_camera.inverse() * truth.T_world_tool[i]);
      ++result.poses;
      result.gross += is_gross(error) ? 1 : 0;
      tip_sum += error.tip_m * error.tip_m;
      angle_sum += error.angle_rad * error.angle_rad;
      result.tip_max_m = std::max(result.tip_max_m, error.tip_m);
      result.tip_errors_m.push_back(error.tip_m);
      result.angle_errors_rad.push_back(error.angle_rad);
      if (t == 0) {
        result.path_truth_m.push_back(truth.T_world_tool[0] * tools.items[0].tip_m);
        result.path_seen_m.push_back(truth.T_world_camera *
                                     (tool.T_camera_tool * tools.items[0].tip_m));
      }
    }
  }
  if (result.poses > 0) {
    result.tip_rms_m = std::sqrt(tip_sum / static_cast<double>(result.poses));
    result.angle_rms_rad = std::sqrt(angle_sum / static_cast<double>(result.poses));
  }
  return result;
}

}  // namespace glint
