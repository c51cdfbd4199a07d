// Counts of tools among false markers that are tracked, tracked with a gross error, or swapped.
//
// platform/runtime/session/accuracy.hpp defines trackable, fresh and gross. Swapped: gross, and
// every marker of the pose is within 20 mm of a marker of one other tool. Findable: trackable, and
// four of the tool's markers were visible in one frame since the run began. Three markers among
// false markers cannot identify a tool without a prior, so the bar applies to findable frames.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/pose/tool.hpp"
#include "platform/lab/experiments/case_list.hpp"
#include "platform/runtime/session/accuracy.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {

class ClutterTally {
 public:
  explicit ClutterTally(const ToolSet& tools) : tools_(tools) {}

  void add(const FrameOutcome& outcome, const FrameGroundTruth& truth);

  [[nodiscard]] std::int64_t trackable() const { return trackable_; }  // tools times frames
  [[nodiscard]] std::int64_t tracked() const { return tracked_; }      // of those, fresh
  [[nodiscard]] std::int64_t gross() const { return gross_; }          // of all poses
  [[nodiscard]] std::int64_t swapped() const { return swapped_; }
  // Returns found, tracked, gross, swapped, trackable_share, and per reason the number of trackable
  // tools that were missed.
  [[nodiscard]] std::vector<Figure> figures(const Bar& found, const Bar& wrong) const;

 private:
  ToolSet tools_;
  std::int64_t judged_ = 0, trackable_ = 0, tracked_ = 0, gross_ = 0, swapped_ = 0;
  std::int64_t findable_ = 0, found_ = 0;
  std::array<bool, k_tools_max> four_seen_{};
  std::array<std::int64_t, static_cast<std::size_t>(k_last_reason) + 1> missed_{};
};

}  // namespace glint
