#include "platform/session/accuracy.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace glint {
namespace {

constexpr double k_gross_m = 0.020;
constexpr double k_gross_rad = 15.0 * 3.14159265358979323846 / 180.0;

double angle_between(const Quaternion& a, const Quaternion& b) { return a.angularDistance(b); }

}  // namespace

FrameOutcome outcome_of(const Estimates& estimates) {
  FrameOutcome outcome;
  outcome.verdict = estimates.verdict.reason;
  for (int t = 0; t < estimates.tool_count; ++t) {
    const auto i = static_cast<std::size_t>(t);
    const Track& track = estimates.tracks[i];
    const bool seen = track.seen_now && estimates.verdict.usable();
    outcome.tools[i] = {seen, track.reason, track.marker_mask, track.T_camera_tool,
                        track.identity != 0};
  }
  return outcome;
}

Accuracy judge(const std::vector<FrameOutcome>& outcomes, const std::vector<sim::SimTruth>& truths,
               const ToolSet& tools, Duration lost_after) {
  Accuracy result;
  double tip_sum = 0, angle_sum = 0;
  std::array<Time, k_tools_max> last_tracked;
  last_tracked.fill(Time{INT64_MIN / 2});
  const std::size_t count = std::min(outcomes.size(), truths.size());
  result.frames = static_cast<std::int64_t>(count);
  for (std::size_t f = 0; f < count; ++f) {
    const FrameOutcome& outcome = outcomes[f];
    const sim::SimTruth& truth = truths[f];
    // A frame that was not in time counts as one that was not tracked, not as none at all.
    if (outcome.verdict != Reason::none && !is_overrun(outcome.verdict)) {
      ++result.refused;
      continue;
    }
    for (int t = 0; t < tools.count; ++t) {
      const auto i = static_cast<std::size_t>(t);
      const ToolOutcome& tool = outcome.tools[i];
      if (!tool.there) continue;
      const int visible = std::popcount(truth.visible_mask[i]);
      const bool recent = truth.mid_exposure - last_tracked[i] <= lost_after;
      if (visible >= 4 || (visible == 3 && recent)) {
        ++result.trackable;
        result.tracked += tool.seen ? 1 : 0;
      }
      if (!tool.seen) continue;
      last_tracked[i] = truth.mid_exposure;

      const Pose T_camera_tool = truth.T_world_camera.inverse() * truth.T_world_tool[i];
      const double tip_error =
          (tool.T_camera_tool * tools.items[i].tip_m - T_camera_tool * tools.items[i].tip_m).norm();
      const double angle = angle_between(tool.T_camera_tool.rotation, T_camera_tool.rotation);
      ++result.poses;
      result.gross += tip_error > k_gross_m || angle > k_gross_rad || visible < 3 ? 1 : 0;
      tip_sum += tip_error * tip_error;
      angle_sum += angle * angle;
      result.tip_max_m = std::max(result.tip_max_m, tip_error);
      result.tip_errors_m.push_back(tip_error);
      result.angle_errors_rad.push_back(angle);
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
