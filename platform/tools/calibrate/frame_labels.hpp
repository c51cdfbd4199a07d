// Labeling of a tool's markers over segments of successive frames.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kernels/pose/labeling.hpp"
#include "kernels/pose/tool.hpp"
#include "platform/formats/points_csv.hpp"

namespace glint {

// Successive frames without a jump, from `begin` to before `end`.
struct Segment {
  std::size_t begin = 0;
  std::size_t end = 0;
  [[nodiscard]] std::size_t length() const { return end - begin; }
};

// Frames belong to one segment if most points have their nearest neighbour within step_max_m.
[[nodiscard]] std::vector<Segment> segments_of(std::span<const PointFrame> frames,
                                               double step_max_m);

// Returns one labeling per frame of the segment; count 0 where the tool was not found. Follows
// several initial labelings and returns the one with the least mean square.
[[nodiscard]] std::vector<Labeling> label_segment(std::span<const PointFrame> frames,
                                                  const Segment& segment, const Tool& tool,
                                                  double noise_m);

}  // namespace glint
