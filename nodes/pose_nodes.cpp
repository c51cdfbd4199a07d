#include "nodes/pose_nodes.hpp"

#include <algorithm>
#include <span>

#include "nodes/predict_tracks.hpp"

namespace glint {
namespace {

template <class T>
std::span<T> first(std::array<T, k_tools_max>& all, int count) {
  return {all.data(), static_cast<std::size_t>(count)};
}

// Reason why the search may have missed a tool: the budget left a part of the frame unsearched.
// none: the whole frame was searched. Near a prediction blobs are always kept, runs are not.
Reason left_unsearched(const Markers& markers, const Predictions& predictions,
                       const Prediction& prediction, const Labelings& labelings) {
  const bool missed =
      labelings.reason == Reason::too_few_markers || labelings.reason == Reason::no_labeling;
  if (!missed) return Reason::none;
  if (markers.incomplete == Reason::runs_full) return Reason::runs_full;
  if (prediction.has_prior) return Reason::none;
  return predictions.search_part_of_frame ? Reason::runs_full : markers.incomplete;
}

void set_owner(const Labeling& labeling, int tool, MarkerOwners& owners) {
  for (const std::int16_t marker : labeling.marker) {
    if (marker >= 0)
      owners[static_cast<std::size_t>(marker) % k_blobs_max] = static_cast<std::int8_t>(tool);
  }
}

}  // namespace

void Correspond::operator()(const FrameVerdict& verdict, const Markers& markers,
                            const graph::Latest<ToolSet>& tools, const Predictions& predictions,
                            graph::Partition partition, ToolLabelings& labelings) noexcept {
  counts_ = {{1}};
  const ToolSet& set = tools.value();
  const int count = tools_within(set, limits);
  CorrespondSettings gated = settings;
  gated.markers_max = limits.blobs;
  gated.search_steps_max = 0;
  // Gates are never narrower than for the declared noise: residuals do not show the error of a
  // marker that is partially occluded or merged with a stray reflection.
  const double noise_ratio = predictions.noise.has_residuals
                                 ? predictions.noise.range_sigma_m / settings.range_sigma_m
                                 : 1;
  if (noise_ratio > 1) {
    gated.range_sigma_m *= noise_ratio;
    gated.max_rms_m *= noise_ratio;
  }
  if (predictions.noise.has_residuals) {
    gated.pixel_sigma_px = std::max(gated.pixel_sigma_px, predictions.noise.pixel_sigma_px);
  }
  for (int t = partition.index; t < count; t += partition.count) {
    const auto i = static_cast<std::size_t>(t);
    Labelings& out = labelings.tools[i];
    const Tool& tool = set.items[i];
    if (!verdict.usable() || tool.marker_count > limits.markers_per_tool) {
      out.count = 0;
      out.reason = verdict.usable() ? Reason::out_of_range : verdict.reason;
      continue;
    }
    const Prediction& prediction = predictions.tools[i];
    gated.prior_gate_m = settings.prior_gate_m + prediction.reach_m;
    gated.prior_sigma_m = prediction.reach_m / k_reach_sigmas;
    gated.only_near = prediction.within_reach_only;
    gated.partial_gate_m = prediction.reach_m + 3 * gated.range_sigma_m;
    gated.search_steps_max += limits.search_steps;
    const CorrespondWork work = propose_labelings(
        markers, tool, gated, prediction.has_prior ? &prediction.T_camera_tool : nullptr, scratch_,
        out);
    gated.search_steps_max -= work.search.steps;
    const Reason unsearched = left_unsearched(markers, predictions, prediction, out);
    if (unsearched != Reason::none) out.reason = unsearched;
    const graph::LoopCounts done = {{0, 1, work.markers, work.pairs.pairs, work.pairs.tests,
                                     work.pairs.words_written, work.search.steps,
                                     work.search.words_narrowed}};
    for (std::size_t loop = 0; loop < k_loops.size(); ++loop) counts_[loop] += done[loop];
  }
}

void AssignMarkers::operator()(const FrameVerdict& verdict, const graph::Latest<ToolSet>& tools,
                               const graph::Parts<ToolLabelings, k_tool_partitions>& labelings,
                               Assignment& assignment) noexcept {
  const int count = tools_within(tools.value(), limits);
  counts_ = {{1}};
  assignment.reason.fill(verdict.reason);
  if (!verdict.usable()) return;
  for (int t = 0; t < count; ++t) {
    const auto i = static_cast<std::size_t>(t);
    per_tool_[i] = labelings[t % k_tool_partitions].tools[i];
  }
  const AssignWork work = assign_markers(first(per_tool_, count), first(chosen_, count),
                                         first(assignment.reason, count));
  owners_.fill(-1);
  for (int t = 0; t < count; ++t) {
    const auto i = static_cast<std::size_t>(t);
    if (chosen_[i] < 0) continue;
    assignment.labeling[i] = per_tool_[i].items[static_cast<std::size_t>(chosen_[i])];
    set_owner(assignment.labeling[i], t, owners_);
  }
  int tests = work.tests;
  for (int t = 0; t < count; ++t) {
    const auto i = static_cast<std::size_t>(t);
    assignment.alternative[i].count = 0;
    if (chosen_[i] < 0) continue;
    const int alternative =
        alternative_of(per_tool_[i], chosen_[i], t, owners_, tools.value().items[i].tip_m, tests);
    if (alternative < 0) continue;
    assignment.alternative[i] = per_tool_[i].items[static_cast<std::size_t>(alternative)];
    set_owner(assignment.alternative[i], t, owners_);  // RefinePose may select it
  }
  counts_ = {{1, count, work.rounds, tests}};
}

}  // namespace glint
