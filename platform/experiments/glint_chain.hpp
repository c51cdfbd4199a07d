// Glint's own chain on one thread, a frame at a time: what the published method is compared with.
#pragma once

#include <memory>
#include <vector>

#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"

namespace glint {

enum class SearchArea { predicted, whole_frame };

struct ChainSetup {
  std::vector<Tool> tools;  // prepared; the first is the one that is asked for
  int reference = -1;       // of them: the one that does not move; -1: none
  HeadNoise head_noise;     // as declared
  SearchArea area = SearchArea::predicted;
};

class GlintChain {
 public:
  // One tool, prepared. whole_frame: no frame knows of the one before, so that each is searched
  // whole and without a prior.
  GlintChain(const Camera& camera, const Tool& tool, SearchArea area = SearchArea::predicted);
  GlintChain(const Camera& camera, const ChainSetup& setup);

  // T_camera_tool as the tracker measured it in this frame, or why not.
  [[nodiscard]] Result<Pose> process(const Frame& frame, const HeadPose& head);

  // T_world_tip as the tick group would give it at the last frame's mid-exposure, followed over the
  // frames before and held to the reference, with its covariance; or why that frame gave none.
  [[nodiscard]] Result<UncertainPose> followed() const;

  [[nodiscard]] const Tracker& tracker() const { return *tracker_; }
  [[nodiscard]] Tracker& tracker() { return *tracker_; }

 private:
  std::unique_ptr<Tracker> tracker_;
};

}  // namespace glint
