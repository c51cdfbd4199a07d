// Glint's own chain on one thread, a frame at a time: what the published method is compared with.
#pragma once

#include <memory>

#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"

namespace glint {

enum class SearchArea { predicted, whole_frame };

class GlintChain {
 public:
  // One tool, prepared. whole_frame: no frame knows of the one before, so that each is searched
  // whole and without a prior.
  GlintChain(const Camera& camera, const Tool& tool, SearchArea area = SearchArea::predicted);

  // T_camera_tool as the tracker measured it in this frame, or why not.
  [[nodiscard]] Result<Pose> process(const Frame& frame, const HeadPose& head);

  [[nodiscard]] const Tracker& tracker() const { return *tracker_; }
  [[nodiscard]] Tracker& tracker() { return *tracker_; }

 private:
  std::unique_ptr<Tracker> tracker_;
};

}  // namespace glint
