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

// Widens the box of what is predicted by one marker with the tool's reach about it.
void include(const CameraModel& camera, const Tool& tool, const Vector3& point,
             const Vector2& pixel, Prediction& prediction) {
  const double radius_px =
      camera.fx * (prediction.reach_m + 2 * tool.marker_radius_m) / std::max(point.z(), 0.05);
  // Eigen's cwiseMin hands its packet's function on by a pointer, whose effects nobody can see.
  for (int axis = 0; axis < 2; ++axis) {
    prediction.low_px[axis] = std::min(prediction.low_px[axis], pixel[axis] - radius_px);
    prediction.high_px[axis] = std::max(prediction.high_px[axis], pixel[axis] + radius_px);
  }
}

// The part of the frame that holds the tool; false where there is none.
bool box_of(const CameraModel& camera, const Prediction& prediction, Roi& box) {
  const Vector2 &low = prediction.low_px, &high = prediction.high_px;
  box = {clamp_to_int(std::floor(low.x()), 0, camera.width),
         clamp_to_int(std::floor(low.y()), 0, camera.height),
         clamp_to_int(std::ceil(high.x()), 0, camera.width),
         clamp_to_int(std::ceil(high.y()), 0, camera.height)};
  return prediction.in_view && box.x0 < box.x1 && box.y0 < box.y1;
}

}  // namespace

void PredictTracks::operator()(const FrameVerdict& verdict, const HeadPose& head,
                               const graph::Latest<ToolSet>& tools,
                               const graph::Previous<Anchor>& anchor,
                               const graph::Previous<Estimates>& last,
                               Predictions& predictions) noexcept {
  // As the frame before corrected it: this one's correction rests on what is yet to be found.
  const Pose T_camera_world = anchor.value().state.corrected(head.T_world_camera).inverse();
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
      predicted = T_camera_world * predicted;
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
    prediction.in_view = true;
    prediction.low_px = Vector2::Constant(1e9);
    prediction.high_px = Vector2::Constant(-1e9);
    for (int m = 0; m < markers; ++m) {
      const Vector3 point = predicted * set.items[t].markers_m[m];
      const Result<Vector2> pixel = project(camera, point, lens_steps);
      prediction.in_view = prediction.in_view && pixel.reason == Reason::none;
      if (!pixel) continue;
      predictions.markers_px[predictions.marker_count++] = pixel.value;
      include(camera, set.items[t], point, pixel.value, prediction);
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
  bool whole_frame = false;
  const int count = tools_within(set, limits);
  for (int t = 0; t < count && !whole_frame; ++t) {
    const Prediction& prediction = predictions.tools[t];
    ++counts_[1];
    Roi box;
    whole_frame =
        !prediction.has_prior || prediction.missed_last || !box_of(camera, prediction, box);
    if (!whole_frame) counts_[2] += add_disjoint(box, rois);
  }
  if (whole_frame) {
    rois.count = 1;
    rois.items[0] = {0, 0, camera.width, camera.height};
  }
}

}  // namespace glint
