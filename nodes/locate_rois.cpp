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

// Adds `box`, first merged with every one that it meets, so that the rest stay disjoint.
void add_disjoint(Roi box, Rois& rois) {
  for (int i = 0; i < rois.count;) {
    if (!overlap(rois.items[i], box)) {
      ++i;
      continue;
    }
    box = unite(box, rois.items[i]);
    rois.items[i] = rois.items[--rois.count];
    i = 0;  // the grown box may meet one passed before; each merge removes one, so this ends
  }
  rois.items[rois.count++] = box;
}

// The box of the tool's markers with its reach about each; nothing where a marker cannot be
// projected.
bool box_of(const CameraModel& camera, const Tool& tool, const Prediction& prediction, Roi& box) {
  double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
  for (int m = 0; m < tool.marker_count; ++m) {
    const Vector3 point = prediction.T_camera_tool * tool.markers_m[m];
    const Result<Vector2> pixel = project(camera, point);
    if (!pixel) return false;
    const double radius_px =
        camera.fx * (prediction.reach_m + 2 * tool.marker_radius_m) / std::max(point.z(), 0.05);
    x0 = std::min(x0, pixel.value.x() - radius_px);
    y0 = std::min(y0, pixel.value.y() - radius_px);
    x1 = std::max(x1, pixel.value.x() + radius_px);
    y1 = std::max(y1, pixel.value.y() + radius_px);
  }
  box = {
      clamp_to_int(std::floor(x0), 0, camera.width), clamp_to_int(std::floor(y0), 0, camera.height),
      clamp_to_int(std::ceil(x1), 0, camera.width), clamp_to_int(std::ceil(y1), 0, camera.height)};
  return box.x0 < box.x1 && box.y0 < box.y1;
}

}  // namespace

void PredictTracks::operator()(const FrameVerdict& verdict, const HeadPose& head,
                               const graph::Latest<ToolSet>& tools,
                               const graph::Previous<Estimates>& last,
                               Predictions& predictions) const noexcept {
  predictions.marker_count = 0;
  const ToolSet& set = tools.value();
  for (int t = 0; t < k_tools_max; ++t) {
    Prediction& prediction = predictions.tools[t];
    prediction = Prediction{};
    if (t >= set.count || !verdict.usable() || verdict.resynchronised) continue;
    const Track& track = last.value().tracks[t];
    if (!track.alive) continue;
    const Duration gap = verdict.stamp.mid_exposure - track.newest.time;
    if (gap > settings.lost_after) continue;

    const bool in_world = track.base == ReferenceFrame::world && head.valid;
    Pose predicted = track.newest.pose;
    const bool moves = track.has_previous && gap <= settings.horizon &&
                       (in_world || track.base == ReferenceFrame::camera);
    if (moves) {
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
    for (int m = 0; m < set.items[t].marker_count; ++m) {
      const Result<Vector2> pixel = project(camera, predicted * set.items[t].markers_m[m]);
      if (pixel) predictions.markers_px[predictions.marker_count++] = pixel.value;
    }
  }
}

void LocateRois::operator()(const FrameVerdict& verdict, const graph::Latest<ToolSet>& tools,
                            const Predictions& predictions, Rois& rois) const noexcept {
  rois.count = 0;
  if (!verdict.usable()) return;
  const ToolSet& set = tools.value();
  bool whole_frame = false;
  for (int t = 0; t < set.count && !whole_frame; ++t) {
    const Prediction& prediction = predictions.tools[t];
    Roi box;
    if (prediction.has_prior && !prediction.missed_last &&
        box_of(camera, set.items[t], prediction, box)) {
      add_disjoint(box, rois);
    } else {
      whole_frame = true;
    }
  }
  if (whole_frame) {
    rois.count = 1;
    rois.items[0] = {0, 0, camera.width, camera.height};
  }
}

}  // namespace glint
