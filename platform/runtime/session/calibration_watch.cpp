#include "platform/runtime/session/calibration_watch.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/pose/lever_arm.hpp"
#include "platform/runtime/session/labelled_markers.hpp"

namespace glint {
namespace {

constexpr double k_apart_m = 0.015, k_apart_cosine = 0.999;  // of half the rotation angle: 5 deg
constexpr int k_fits_min = 20;
constexpr Duration k_sight_period = milliseconds(200), k_sight_gap_max = milliseconds(500);
constexpr double k_uncorrelated_s = 1e6;  // longer than any correlation
constexpr unsigned k_rejected_flags =
    k_marker_touches_edge | k_marker_has_neighbour | k_marker_not_isolated | k_marker_wrapped;

bool is_apart(const Pose& a, const Pose& b) {
  return (a.translation - b.translation).squaredNorm() > k_apart_m * k_apart_m ||
         std::abs(a.rotation.dot(b.rotation)) < k_apart_cosine;
}

}  // namespace

CalibrationMonitor::CalibrationMonitor(const Cell& cell) : cell_(cell) {
  for (int t = 0; t < k_tools_max; ++t) tools_[static_cast<std::size_t>(t)].tool = t;
}

void CalibrationMonitor::add_frame(const Tracker& tracker) noexcept {
  const FrameVerdict& verdict = tracker.token<FrameVerdict>();
  if (!verdict.usable()) return;
  if (verdict.resynchronised) {
    walk_.restart_clock();
    consecutive_sightings_ = 0;
    last_sight_.reset();
  }
  const ToolSet& set = tracker.token<graph::Latest<ToolSet>>().value();
  const int count = std::min(set.count, k_tools_max);
  if (count == 0) return;
  const HeadPose& head = tracker.token<HeadPose>();
  if (head.valid) walk_.observe(head, cell_.head_noise);
  world_.work();
  const auto turn = static_cast<std::size_t>(seen_++ % static_cast<std::uint64_t>(count));
  add_fit_of_tool(tracker, set.items[turn], tools_[turn]);
  shared_.write_slot() = {tools_[turn], world_};
  shared_.publish(seen_, 0);
}

bool CalibrationMonitor::body_is_due(int tool, const HeadPose& head, Time now) const {
  return tool == cell_.reference && head.valid && head.time == now && world_.idle() &&
         (consecutive_sightings_ == 0 || now - body_.head.time >= k_sight_period);
}

// Adds a sighting when the next one is there, and takes the head's velocity from the sightings on
// either side. Over a shorter time the velocity would contain too much of the headset's own error.
void CalibrationMonitor::add_sighting(const OptimalFit& fit, const HeadPose& head) noexcept {
  BodySighting seen;
  seen.head = {head.time, head.T_world_camera};
  if (consecutive_sightings_ > 0 && head.time - body_.head.time > k_sight_gap_max)
    consecutive_sightings_ = 0;
  const Quaternion& turn = head.T_world_camera.rotation;
  BodyMeasurement& sight = seen.sight;
  sight.T_world_body = head.T_world_camera * fit.T_camera_tool;
  sight.covariance = rotated_covariance(fit.covariance, turn);
  sight.by_errors.topLeftCorner<3, k_common_errors>() =
      turn.toRotationMatrix() * fit.by_errors.topRows<3>();
  sight.by_errors.bottomLeftCorner<3, k_common_errors>() =
      turn.toRotationMatrix() * fit.by_errors.bottomRows<3>();
  if (consecutive_sightings_ == 2) {
    const Velocity velocity = velocity_between(head_before_, seen.head);
    const Vector3 lever = body_.sight.T_world_body.translation - body_.head.pose.translation;
    body_.sight.by_errors.col(k_common_errors)
        << time_sigma_s() * (velocity.linear_m_s + velocity.angular_rad_s.cross(lever)),
        time_sigma_s() * velocity.angular_rad_s;
    const Time time = body_.head.time;
    const double since_s = last_sight_ ? (time - *last_sight_).seconds() : k_uncorrelated_s;
    body_.sight.walked =
        walk_.transition_over(since_s, body_.sight.T_world_body.translation, cell_.head_noise);
    if (world_.add(body_.sight)) last_sight_ = time;
  }
  head_before_ = body_.head;
  body_ = seen;
  consecutive_sightings_ = std::min(consecutive_sightings_ + 1, 2);
}

double CalibrationMonitor::time_sigma_s() const {
  return std::hypot(cell_.camera.uncertainty.time_stamp_s, cell_.head_noise.time_stamp_s);
}

void CalibrationMonitor::add_fit_of_tool(const Tracker& tracker, const Tool& tool,
                                         Watched& watched) noexcept {
  const auto at = static_cast<std::size_t>(watched.tool);
  if (watched.identity != tool.identity) {
    watched.errors = {};
    watched.identity = tool.identity;
  }
  const Assignment& assignment = tracker.token<Assignment>();
  if (!tool.present() || assignment.reason[at] != Reason::none) return;
  const FittedTool& fitted = tracker.parts<FittedTools>(watched.tool % k_tool_partitions).tools[at];
  if (fitted.ambiguous()) return;
  const Labeling& labeling = labeling_of(assignment, fitted, at);
  const Pose& pose = fitted.reason == Reason::none ? fitted.T_camera_tool : labeling.T_camera_tool;
  const bool apart = is_apart(pose, watched.counted);
  const HeadPose& head = tracker.token<HeadPose>();
  const bool due = body_is_due(watched.tool, head, tracker.token<FrameStamp>().mid_exposure);
  if (!apart && !due) return;
  const Camera& camera = cell_.camera;
  const LabelledMarkers seen(tracker.token<Markers>(), labeling, tool,
                             noise_of(tracker.output<Estimates>().noise, camera), k_rejected_flags);
  const Result<OptimalFit> fit =
      add_fit(seen.weighted(), seen.sights(), seen.marker_indices(), pose, camera.uncertainty,
              tool.marker_sigma_m, apart ? &watched.errors : nullptr);
  if (!fit) return;
  if (apart) watched.counted = pose;
  if (due) add_sighting(fit.value, head);
}

std::vector<CalibrationFinding> CalibrationMonitor::findings_of(const AllWatched& tools,
                                                                const WorldErrors& world) const {
  std::vector<ToolErrors> seen;
  for (int t = 0; t < cell_.tools.count; ++t) {
    const Watched& watched = tools[static_cast<std::size_t>(t)];
    const Tool& tool = cell_.tools.items[static_cast<std::size_t>(t)];
    if (watched.errors.fits < k_fits_min || watched.identity != tool.identity) continue;
    seen.push_back({tool.name.data(), tool.marker_count, tool.marker_sigma_m, watched.errors});
  }
  return calibration_findings(seen, cell_.camera.uncertainty, &world, time_sigma_s());
}

std::vector<CalibrationFinding> CalibrationMonitor::findings() const {
  return findings_of(tools_, world_);
}

void CalibrationMonitor::review(Time now, CalibrationFindingsStore& notes) {
  if (shared_.sample()) {
    const Newest& newest = shared_.value();
    reviewed_[static_cast<std::size_t>(newest.tool.tool)] = newest.tool;
    reviewed_world_ = newest.world;
  }
  if (now < next_review_) return;
  next_review_ = now + k_review;
  notes.set(findings_of(reviewed_, reviewed_world_));
}

}  // namespace glint
