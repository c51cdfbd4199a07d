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

// Adds `box`, merged with every ROI that it overlaps, so that all ROIs stay disjoint. Returns the
// number of comparisons.
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
    i = 0;  // recheck: the larger box may overlap an earlier one; each merge removes one ROI
  }
  rois.items[rois.count++] = box;
  return comparisons;
}

// Bounding box of the tool in the frame; returns false if the tool is outside.
bool box_of(const CameraModel& camera, const Prediction& prediction, Roi& box) {
  const Vector2 &low = prediction.low_px, &high = prediction.high_px;
  box = {clamp_to_int(std::floor(low.x()), 0, camera.width),
         clamp_to_int(std::floor(low.y()), 0, camera.height),
         clamp_to_int(std::ceil(high.x()), 0, camera.width),
         clamp_to_int(std::ceil(high.y()), 0, camera.height)};
  return prediction.in_view && box.x0 < box.x1 && box.y0 < box.y1;
}

// Part of the frame to search, different in each frame: half or a quarter of the columns; in every
// fourth frame also a quarter of the rows. Multiples of the golden ratio move its centre over the
// whole frame and leave no large gap for long (low-discrepancy sequence).
Roi part_of_frame(const CameraModel& camera, std::uint32_t frame_number) {
  constexpr std::uint32_t golden = 0x9E3779B9;  // 2^32 / phi
  const auto share = [](std::uint32_t position, int room) {
    return static_cast<int>(position * static_cast<std::uint64_t>(room) >> 32);
  };
  const int width = camera.width / (frame_number % 2 == 0 ? 4 : 2);
  const int height = frame_number % 4 == 0 ? camera.height / 4 : camera.height;
  const int x = share(frame_number * golden, camera.width) - width / 2;
  const int y = height == camera.height
                    ? 0
                    : share(frame_number / 4 * golden * golden, camera.height) - height / 2;
  return {std::max(x, 0), std::max(y, 0), std::min(x + width, camera.width),
          std::min(y + height, camera.height)};
}

}  // namespace

// Searches one part of the frame and at most limits.tools - 1 boxes of tools, tracked tools first.
void LocateRois::search_part(const ToolSet& set, int count, const Predictions& predictions,
                             Rois& rois) noexcept {
  rois.items[0] = part_of_frame(camera, predictions.frame_number);
  rois.count = 1;
  int boxes = 1;
  for (const bool missed : {false, true}) {
    for (int t = 0; t < count && boxes < limits.tools; ++t) {
      const Prediction& prediction = predictions.tools[t];
      Roi box;
      if (!set.items[t].present() || !prediction.has_prior ||
          prediction.undetected_last != missed || !box_of(camera, prediction, box))
        continue;
      ++boxes;
      ++counts_[graph::loop_of<LocateRois>("tools")];
      counts_[graph::loop_of<LocateRois>("comparisons")] += add_disjoint(box, rois);
    }
  }
}

void LocateRois::operator()(const FrameVerdict& verdict, const graph::Latest<ToolSet>& tools,
                            const Predictions& predictions, Rois& rois) noexcept {
  rois.count = 0;
  counts_ = {{1}};
  if (!verdict.usable()) return;
  const ToolSet& set = tools.value();
  const int count = tools_within(set, limits);
  if (predictions.search_part_of_frame) return search_part(set, count, predictions, rois);
  bool whole_frame = false;
  for (int t = 0; t < count && !whole_frame; ++t) {
    if (!set.items[t].present()) continue;
    const Prediction& prediction = predictions.tools[t];
    ++counts_[graph::loop_of<LocateRois>("tools")];
    Roi box;
    whole_frame =
        !prediction.has_prior || prediction.undetected_last || !box_of(camera, prediction, box);
    if (!whole_frame) counts_[graph::loop_of<LocateRois>("comparisons")] += add_disjoint(box, rois);
  }
  if (whole_frame) {
    rois.count = 1;
    rois.items[0] = {0, 0, camera.width, camera.height};
  }
}

}  // namespace glint
