// How often tools among strays are tracked, tracked with a gross error, and taken for each other.
//
// Trackable, fresh and gross are those of platform/session/accuracy.hpp. Swapped: gross, and every
// marker of the pose lies within 20 mm of one of some other tool's. Findable: trackable, and four
// of the tool's markers have been visible since the run began. Three markers among strays are not
// enough to name a tool that was never seen, so the bar stands on the findable frames.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/pose/tool.hpp"
#include "platform/experiments/case_list.hpp"
#include "platform/session/accuracy.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {

class ClutterTally {
 public:
  explicit ClutterTally(const ToolSet& tools) : tools_(tools) {}

  void add(const FrameOutcome& outcome, const FrameTruth& truth);

  [[nodiscard]] std::int64_t trackable() const { return trackable_; }  // tools and frames
  [[nodiscard]] std::int64_t tracked() const { return tracked_; }      // of those, fresh
  [[nodiscard]] std::int64_t gross() const { return gross_; }          // of all poses
  [[nodiscard]] std::int64_t swapped() const { return swapped_; }
  // found, tracked, gross, swapped, trackable_share, and how often which reason left a trackable
  // tool out.
  [[nodiscard]] std::vector<Figure> figures(const Bar& found, const Bar& wrong) const;

 private:
  ToolSet tools_;
  std::int64_t judged_ = 0, trackable_ = 0, tracked_ = 0, gross_ = 0, swapped_ = 0;
  std::int64_t findable_ = 0, found_ = 0;
  std::array<bool, k_tools_max> four_seen_{};
  std::array<std::int64_t, static_cast<std::size_t>(k_last_reason) + 1> missed_{};
};

}  // namespace glint
