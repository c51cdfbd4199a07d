// How often tools among strays are found, found wrongly, and taken for each other.
//
// A tool counts as visible with four or more of its markers visible by the simulator's rule, or
// with three while a measured pose is at most lost_after old. Tracked: this frame gave a measured
// pose. Gross: it did, and a marker is more than 20 mm or the orientation more than 15 degrees off.
// The pose is what the filter has after the frame; gross_fits counts the frame's own, before it.
// Swapped: gross, and every marker that it names lies within 20 mm of one of some other tool's.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernels/pose/tool.hpp"
#include "platform/experiments/case_list.hpp"
#include "platform/session/accuracy.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {

class ClutterTally {
 public:
  ClutterTally(const ToolSet& tools, Duration lost_after) : tools_(tools), lost_after_(lost_after) {
    last_tracked_.fill(Time{INT64_MIN / 2});
  }

  // Frames in the order of their time.
  void add(const FrameOutcome& outcome, const sim::SimTruth& truth);

  [[nodiscard]] std::int64_t visible() const { return visible_; }  // tools and frames
  [[nodiscard]] std::int64_t tracked() const { return tracked_; }  // of those
  [[nodiscard]] std::int64_t gross() const { return gross_; }      // of all poses
  [[nodiscard]] std::int64_t swapped() const { return swapped_; }
  // visible_share, tracked, gross, swapped, and how often which reason left a visible tool out.
  [[nodiscard]] std::vector<Figure> figures(const Bar& tracked, const Bar& wrong) const;

 private:
  ToolSet tools_;
  Duration lost_after_;
  std::array<Time, k_tools_max> last_tracked_;
  std::int64_t judged_ = 0, visible_ = 0, tracked_ = 0, gross_ = 0, swapped_ = 0;
  std::array<std::int64_t, static_cast<std::size_t>(k_last_reason) + 1> missed_{};
};

}  // namespace glint
