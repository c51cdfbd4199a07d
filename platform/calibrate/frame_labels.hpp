// Which point of a frame is which marker of a tool, over whole segments of a recording.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kernels/pose/labeling.hpp"
#include "kernels/pose/tool.hpp"
#include "platform/sensors/points_csv.hpp"

namespace glint {

// Frames from `begin` to before `end` that follow each other without a jump.
struct Segment {
  std::size_t begin = 0;
  std::size_t end = 0;
  [[nodiscard]] std::size_t length() const { return end - begin; }
};

// Two frames belong together where most points have their nearest neighbour within step_max_m.
[[nodiscard]] std::vector<Segment> segments_of(std::span<const PointFrame> frames,
                                               double step_max_m);

// One labeling a frame of the segment; count 0 where the tool was not found. Several ways to begin
// are followed; the one with the least mean square counts.
[[nodiscard]] std::vector<Labeling> label_segment(std::span<const PointFrame> frames,
                                                  const Segment& segment, const Tool& tool,
                                                  double noise_m);

}  // namespace glint
