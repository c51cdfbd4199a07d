#include "platform/session/calibration_watch.hpp"

#include <algorithm>
#include <cmath>

#include "platform/session/labelled_markers.hpp"

namespace glint {
namespace {

constexpr double k_apart_m = 0.015, k_apart_cosine = 0.999;  // of half the rotation: 5 deg
constexpr int k_fits_least = 20;
constexpr unsigned k_doubtful =
    k_marker_touches_edge | k_marker_has_neighbour | k_marker_uneven | k_marker_wrapped;

bool is_apart(const Pose& a, const Pose& b) {
  return (a.translation - b.translation).squaredNorm() > k_apart_m * k_apart_m ||
         std::abs(a.rotation.dot(b.rotation)) < k_apart_cosine;
}

}  // namespace

CalibrationWatch::CalibrationWatch(const Cell& cell) : cell_(cell) {
  for (int t = 0; t < k_tools_max; ++t) tools_[static_cast<std::size_t>(t)].tool = t;
}

void CalibrationWatch::see(const Tracker& tracker) noexcept {
  if (!tracker.token<FrameVerdict>().usable()) return;
  const ToolSet& set = tracker.token<graph::Latest<ToolSet>>().value();
  const int count = std::min(set.count, k_tools_max);
  if (count == 0) return;
  const auto turn = static_cast<std::size_t>(seen_++ % static_cast<std::uint64_t>(count));
  see(tracker, set.items[turn], tools_[turn]);
  shared_.write_slot() = tools_[turn];
  shared_.publish(seen_, 0);
}

void CalibrationWatch::see(const Tracker& tracker, const Tool& tool, Watched& watched) noexcept {
  const auto at = static_cast<std::size_t>(watched.tool);
  if (watched.identity != tool.identity) {
    watched.errors = {};
    watched.identity = tool.identity;
  }
  const Assignment& assignment = tracker.token<Assignment>();
  if (!tool.present() || assignment.reason[at] != Reason::none) return;
  const FittedTool& fitted = tracker.parts<FittedTools>(watched.tool % k_tool_slices).tools[at];
  const Labeling& labeling = labeling_of(assignment, fitted, at);
  const Pose& pose = fitted.reason == Reason::none ? fitted.T_camera_tool : labeling.T_camera_tool;
  if (!is_apart(pose, watched.counted)) return;
  const Camera& camera = cell_.camera;
  const LabelledMarkers seen(tracker.token<Markers>(), labeling, tool,
                             noise_of(tracker.output<Estimates>().noise, camera), k_doubtful);
  const int before = watched.errors.fits;
  add_fit(seen.weighed(), seen.sights(), seen.numbers(), pose, camera.uncertainty,
          tool.marker_sigma_m, watched.errors);
  if (watched.errors.fits > before) watched.counted = pose;
}

std::vector<CalibrationFinding> CalibrationWatch::findings_of(const AllWatched& tools) const {
  std::vector<ToolErrors> seen;
  for (int t = 0; t < cell_.tools.count; ++t) {
    const Watched& watched = tools[static_cast<std::size_t>(t)];
    const Tool& tool = cell_.tools.items[static_cast<std::size_t>(t)];
    if (watched.errors.fits < k_fits_least || watched.identity != tool.identity) continue;
    seen.push_back({tool.name.data(), tool.marker_count, tool.marker_sigma_m, watched.errors});
  }
  return calibration_findings(seen, cell_.camera.uncertainty);
}

std::vector<CalibrationFinding> CalibrationWatch::findings() const { return findings_of(tools_); }

void CalibrationWatch::review(Time now, CalibrationNotes& notes) {
  if (shared_.sample()) {
    const Watched& newest = shared_.value();
    reviewed_[static_cast<std::size_t>(newest.tool)] = newest;
  }
  if (now < next_review_) return;
  next_review_ = now + k_review;
  notes.set(findings_of(reviewed_));
}

}  // namespace glint
