#include "nodes/name_few.hpp"

#include <span>

namespace glint {

void NameFew::operator()(const FrameVerdict& verdict, const Markers& markers,
                         const graph::Latest<ToolSet>& tools, const Predictions& predictions,
                         const Assignment& assignment, SeenFew& seen) noexcept {
  counts_ = {{1}};
  for (PartialMarkers& few : seen.tools) few.count = 0;
  if (!verdict.usable()) return;
  const ToolSet& set = tools.value();
  const auto count = static_cast<std::size_t>(tools_within(set, limits));
  TakenMarkers taken;
  bool any_wanted = false;
  for (std::size_t t = 0; t < count; ++t) {
    const Prediction& prediction = predictions.tools[t];
    PredictedTool& expected = expected_[t];
    expected = {&set.items[t], prediction.T_camera_tool, prediction.covariance,
                prediction.follows_motion && set.items[t].marker_count <= limits.markers_per_tool,
                assignment.reason[t] != Reason::none};
    any_wanted = any_wanted || (expected.predicted && expected.needs_labeling);
    if (expected.needs_labeling) continue;
    for (const Labeling* labeling : {&assignment.labeling[t], &assignment.alternative[t]}) {
      if (labeling->count == 0) continue;
      for (const std::int16_t marker : labeling->marker) {
        if (marker >= 0) taken[static_cast<std::size_t>(marker) % k_blobs_max] = true;
      }
    }
  }
  if (!any_wanted) return;
  const PartialWork work = identify_partial({expected_.data(), count}, markers, limits.blobs, taken,
                                            noise_now(predictions.noise, noise), scratch_,
                                            std::span(seen.tools).first(count));
  counts_ = {{1, static_cast<std::int64_t>(count), work.gates, work.tests}};
}

}  // namespace glint
