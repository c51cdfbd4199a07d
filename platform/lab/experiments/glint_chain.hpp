// Glint's tracker graph on one thread, one frame at a time, for comparison with the baseline.
#pragma once

#include <memory>
#include <vector>

#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"

namespace glint {

enum class SearchArea { predicted, whole_frame };

struct ChainSetup {
  std::vector<Tool> tools;  // prepared; the result is the pose of the first
  int reference = -1;       // index of the static reference body; -1: none
  HeadNoise head_noise;     // as declared
  SearchArea area = SearchArea::predicted;
};

class GlintChain {
 public:
  // Requires one prepared tool. whole_frame: frames are independent; each is searched whole and
  // without a prior.
  GlintChain(const Camera& camera, const Tool& tool, SearchArea area = SearchArea::predicted);
  GlintChain(const Camera& camera, const ChainSetup& setup);

  // Returns T_camera_tool as measured in this frame, or the reason for none.
  [[nodiscard]] Result<Pose> process(const Frame& frame, const HeadPose& head);

  // Returns T_world_tip with its covariance at the last frame's mid-exposure, as the tick group
  // would compute it: filtered over the previous frames, drift-corrected by the reference. Returns
  // a reason if that frame gave none.
  [[nodiscard]] Result<UncertainPose> followed() const;

  [[nodiscard]] const Tracker& tracker() const { return *tracker_; }
  [[nodiscard]] Tracker& tracker() { return *tracker_; }

 private:
  std::unique_ptr<Tracker> tracker_;
};

}  // namespace glint
