// Box of a grown centroid: a blob's bounding box, grown by two pixels and clipped to the frame, in
// groups of eight columns.
#pragma once

#include <algorithm>

#include "kernels/image/blob_scratch.hpp"
#include "kernels/image/frame.hpp"

namespace glint {

// The box, grown by two on each side, fits a 64-bit word.
inline constexpr int k_grown_box_max = 60;

struct GrownBox {
  int left = 0;             // the frame's column at bit 0 of a row mask
  int column_groups = 0;    // groups of eight columns, inside the frame if it is wide enough
  int top = 0, bottom = 0;  // rows inside the frame, half open

  // Cost in pixels. The masks of a row cost as much as eight pixels.
  [[nodiscard]] int pixels() const { return 8 * (bottom - top) * (column_groups + 1); }
};

[[nodiscard]] inline bool fits_grown_box(const Component& component) {
  return component.x1 - component.x0 <= k_grown_box_max &&
         component.y1 - component.y0 <= k_grown_box_max;
}

[[nodiscard]] inline GrownBox grown_box(const Frame& frame, const Component& component) {
  const int begin = std::max(component.x0 - 2, 0);
  const int end = std::min(component.x1 + 2, frame.width());
  GrownBox box;
  box.column_groups = (end - begin + 7) / 8;
  box.left = std::clamp(begin, 0, std::max(frame.width() - 8 * box.column_groups, 0));
  box.top = std::max(component.y0 - 2, 0);
  box.bottom = std::min(component.y1 + 2, frame.height());
  return box;
}

}  // namespace glint
