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

void LocateRois::operator()(const FrameVerdict& verdict, const graph::Latest<ToolSet>& tools,
                            const Predictions& predictions, Rois& rois) noexcept {
  rois.count = 0;
  counts_ = {{1}};
  if (!verdict.usable()) return;
  const ToolSet& set = tools.value();
  bool whole_frame = false;
  const int count = tools_within(set, limits);
  for (int t = 0; t < count && !whole_frame; ++t) {
    if (!set.items[t].present()) continue;
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
