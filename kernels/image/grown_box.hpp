// The box in which a blob's centroid is weighed: the blob's own, grown by two pixels, cut at the
// frame's border, in columns that are loaded four at a time.
#pragma once

#include <algorithm>

#include "kernels/image/blob_scratch.hpp"
#include "kernels/image/frame.hpp"

namespace glint {

// The box, grown by two on each side, fits a 64-bit word.
inline constexpr int k_grown_box_max = 60;

struct GrownBox {
  int left = 0;                      // the frame's column that bit 0 of a row's mask stands for
  int first_four = 0, end_four = 0;  // columns left + 4 first_four .. left + 4 end_four
  int top = 0, bottom = 0;           // rows inside the frame, half open

  [[nodiscard]] int fours() const { return (bottom - top) * (end_four - first_four); }
};

[[nodiscard]] inline bool fits_grown_box(const Component& component) {
  return component.x1 - component.x0 <= k_grown_box_max &&
         component.y1 - component.y0 <= k_grown_box_max;
}

[[nodiscard]] inline GrownBox grown_box(const Frame& frame, const Component& component) {
  GrownBox box;
  // 64 columns that all lie inside the frame, where it has as many.
  box.left = std::clamp(component.x0 - 2, 0, std::max(frame.width() - 64, 0));
  box.first_four = std::max(component.x0 - 2 - box.left, 0) / 4;
  box.end_four = (std::min(component.x1 + 2 - box.left, 64) + 3) / 4;
  box.top = std::max(component.y0 - 2, 0);
  box.bottom = std::min(component.y1 + 2, frame.height());
  return box;
}

}  // namespace glint
