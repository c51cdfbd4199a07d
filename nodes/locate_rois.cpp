#include "nodes/locate_rois.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

int clamp_to_int(double value, int low, int high) {
  return static_cast<int>(std::clamp(value, static_cast<double>(low), static_cast<double>(high)));
}

bool overlap(const Roi& a, const Roi& b) {
  return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

Roi unite(const Roi& a, const Roi& b) {
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

// Adds `box`, first merged with every one that it meets, so that the rest stay disjoint. Returns
// the number of comparisons.
int add_disjoint(Roi box, Rois& rois) {
  int comparisons = 0;
  for (int i = 0; i < rois.count;) {
    ++comparisons;
    if (!overlap(rois.items[i], box)) {
      ++i;
      continue;
    }
    box = unite(box, rois.items[i]);
    rois.items[i] = rois.items[--rois.count];
    i = 0;  // the grown box may meet one passed before; each merge removes one, so this ends
  }
  rois.items[rois.count++] = box;
  return comparisons;
}

// The box of the tool's first `markers` markers with its reach about each; nothing where one of
// them cannot be projected.
bool box_of(const CameraModel& camera, const Tool& tool, const Prediction& prediction, int markers,
            int& lens_steps, Roi& box) {
  double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
  bool in_view = true;
  for (int m = 0; m < markers; ++m) {
    const Vector3 point = prediction.T_camera_tool * tool.markers_m[m];
    const Result<Vector2> pixel = project(camera, point, lens_steps);
    in_view = in_view && pixel.reason == Reason::none;
    const double radius_px =
        camera.fx * (prediction.reach_m + 2 * tool.marker_radius_m) / std::max(point.z(), 0.05);
    x0 = std::min(x0, pixel.value.x() - radius_px);
    y0 = std::min(y0, pixel.value.y() - radius_px);
    x1 = std::max(x1, pixel.value.x() + radius_px);
    y1 = std::max(y1, pixel.value.y() + radius_px);
  }
  if (!in_view) return false;
  box = {
      clamp_to_int(std::floor(x0), 0, camera.width), clamp_to_int(std::floor(y0), 0, camera.height),
      clamp_to_int(std::ceil(x1), 0, camera.width), clamp_to_int(std::ceil(y1), 0, camera.height)};
  return box.x0 < box.x1 && box.y0 < box.y1;
}

}  // namespace

void PredictTracks::operator()(const FrameVerdict& verdict, const HeadPose& head,
                               const graph::Latest<ToolSet>& tools,
                               const graph::Previous<Estimates>& last,
                               Predictions& predictions) noexcept {
  predictions.marker_count = 0;
  counts_ = {{1}};
  int lens_steps = 0;
  const ToolSet& set = tools.value();
  const int count = tools_within(set, limits);
  for (int t = 0; t < k_tools_max; ++t) {
    Prediction& prediction = predictions.tools[t];
    prediction = Prediction{};
    if (t >= count || !verdict.usable() || verdict.resynchronised) continue;
    const Track& track = last.value().tracks[t];
    if (!track.alive) continue;
    const Duration gap = verdict.stamp.mid_exposure - track.newest.time;
    if (gap > settings.lost_after) continue;

    ++counts_[1];
    const bool in_world = track.base == ReferenceFrame::world && head.valid;
    Pose predicted = track.newest.pose;
    const bool moves = track.has_previous && gap <= settings.horizon &&
                       (in_world || track.base == ReferenceFrame::camera);
    if (moves) {
      ++counts_[2];
      predicted =
          extrapolate(track.previous, track.newest, verdict.stamp.mid_exposure, settings.horizon);
    }
    if (in_world) {
      predicted = head.T_world_camera.inverse() * predicted;
    } else if (track.base == ReferenceFrame::world) {
      predicted = track.T_camera_tool;  // the head's pose went missing: hold what the camera saw
    }
    prediction.has_prior = true;
    prediction.missed_last = !track.seen_now;
    prediction.T_camera_tool = predicted;
    const double seconds = gap.seconds();
    // Without a velocity the tool may have moved at a hand's speed, 1 m/s, in any direction.
    const double drift_m = moves ? 0.0 : 1.0 * seconds;
    prediction.reach_m =
        settings.margin_m + drift_m + 0.5 * settings.acceleration_max_m_s2 * seconds * seconds;
    const int markers = markers_within(set.items[t], limits);
    counts_[3] += markers;
    for (int m = 0; m < markers; ++m) {
      const Vector3 point = predicted * set.items[t].markers_m[m];
      const Result<Vector2> pixel = project(camera, point, lens_steps);
      if (pixel) predictions.markers_px[predictions.marker_count++] = pixel.value;
    }
  }
  counts_[4] = lens_steps;
}

void LocateRois::operator()(const FrameVerdict& verdict, const graph::Latest<ToolSet>& tools,
                            const Predictions& predictions, Rois& rois) noexcept {
  rois.count = 0;
  counts_ = {{1}};
  if (!verdict.usable()) return;
  const ToolSet& set = tools.value();
  int lens_steps = 0;
  bool whole_frame = false;
  const int count = tools_within(set, limits);
  for (int t = 0; t < count && !whole_frame; ++t) {
    const Prediction& prediction = predictions.tools[t];
    whole_frame = !prediction.has_prior || prediction.missed_last;
    if (whole_frame) break;
    const int markers = markers_within(set.items[t], limits);
    ++counts_[1];
    counts_[2] += markers;
    Roi box;
    whole_frame = !box_of(camera, set.items[t], prediction, markers, lens_steps, box);
    if (!whole_frame) counts_[4] += add_disjoint(box, rois);
  }
  counts_[3] = lens_steps;
  if (whole_frame) {
    rois.count = 1;
    rois.items[0] = {0, 0, camera.width, camera.height};
  }
}

}  // namespace glint
