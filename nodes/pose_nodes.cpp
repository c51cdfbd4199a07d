#include "nodes/pose_nodes.hpp"

#include <span>

namespace glint {
namespace {

template <class T>
std::span<T> first(std::array<T, k_tools_max>& all, int count) {
  return {all.data(), static_cast<std::size_t>(count)};
}

// Where the labelled markers' centres are, in the camera's frame, and where the tool has them.
struct PointPairs {
  std::array<Vector3, k_markers_per_tool_max> model, measured;
  std::size_t count = 0;
  std::uint8_t mask = 0;
};

PointPairs pairs_of(const Tool& tool, int marker_count, const Markers& markers,
                    const Labeling& labeling) {
  PointPairs pairs;
  for (int i = 0; i < marker_count; ++i) {
    const int seen = labeling.marker[static_cast<std::size_t>(i)];
    if (seen < 0) continue;
    const Marker& marker = markers.items[static_cast<std::size_t>(seen)];
    pairs.model[pairs.count] = tool.markers_m[static_cast<std::size_t>(i)];
    pairs.measured[pairs.count] = marker.ray * (marker.surface_range_m + tool.centre_offset_m());
    ++pairs.count;
    pairs.mask = static_cast<std::uint8_t>(pairs.mask | (1u << i));
  }
  return pairs;
}

std::array<Matrix3, k_markers_per_tool_max> covariances_of(const PointPairs& pairs,
                                                           const MarkerNoise& noise) {
  std::array<Matrix3, k_markers_per_tool_max> covariances;
  for (std::size_t i = 0; i < pairs.count; ++i) {
    const double range = pairs.measured[i].norm();
    const double across =
        noise.focal_px > 0 ? noise.pixel_sigma_px * range / noise.focal_px : noise.range_sigma_m;
    covariances[i] = marker_covariance(pairs.measured[i] / range, noise.range_sigma_m, across);
  }
  return covariances;
}

}  // namespace

void Correspond::operator()(const FrameVerdict& verdict, const Markers& markers,
                            const graph::Latest<ToolSet>& tools, const Predictions& predictions,
                            graph::Slice slice, ToolLabelings& labelings) noexcept {
  counts_ = {{1}};
  const ToolSet& set = tools.value();
  const int count = tools_within(set, limits);
  CorrespondSettings gated = settings;
  gated.markers_max = limits.blobs;
  gated.search_steps_max = 0;
  for (int t = slice.index; t < count; t += slice.count) {
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
    gated.search_steps_max += limits.search_steps;
    const CorrespondWork work = propose_labelings(
        markers, tool, gated, prediction.has_prior ? &prediction.T_camera_tool : nullptr, scratch_,
        out);
    gated.search_steps_max -= work.search.steps;
    const graph::LoopCounts done = {{0, 1, work.markers, work.pairs.pairs, work.pairs.tests,
                                     work.pairs.words_written, work.search.steps,
                                     work.search.words_narrowed}};
    for (std::size_t loop = 0; loop < k_loops.size(); ++loop) counts_[loop] += done[loop];
  }
}

void AssignMarkers::operator()(const FrameVerdict& verdict, const graph::Latest<ToolSet>& tools,
                               const graph::Parts<ToolLabelings, k_tool_slices>& labelings,
                               Assignment& assignment) noexcept {
  const int count = tools_within(tools.value(), limits);
  counts_ = {{1}};
  assignment.reason.fill(verdict.reason);
  if (!verdict.usable()) return;
  for (int t = 0; t < count; ++t) {
    const auto i = static_cast<std::size_t>(t);
    per_tool_[i] = labelings[t % k_tool_slices].tools[i];
  }
  const AssignWork work = assign_markers(first(per_tool_, count), first(chosen_, count),
                                         first(assignment.reason, count));
  counts_ = {{1, count, work.rounds, work.tests}};
  for (int t = 0; t < count; ++t) {
    const auto i = static_cast<std::size_t>(t);
    if (chosen_[i] < 0) continue;
    assignment.labeling[i] = per_tool_[i].items[static_cast<std::size_t>(chosen_[i])];
  }
}

void FitRigid::operator()(const FrameVerdict& verdict, const Markers& markers,
                          const graph::Latest<ToolSet>& tools, const Assignment& assignment,
                          graph::Slice slice, FittedTools& fitted) noexcept {
  counts_ = {{1}};
  const ToolSet& set = tools.value();
  const int count = tools_within(set, limits);
  for (int t = slice.index; t < count; t += slice.count) {
    ++counts_[1];
    const auto i = static_cast<std::size_t>(t);
    FittedTool& out = fitted.tools[i];
    out = FittedTool{};
    out.reason = verdict.usable() ? assignment.reason[i] : verdict.reason;
    if (out.reason != Reason::none) continue;

    const PointPairs pairs = pairs_of(set.items[i], markers_within(set.items[i], limits), markers,
                                      assignment.labeling[i]);
    ++counts_[2];
    counts_[3] += static_cast<std::int64_t>(pairs.count);
    const std::span model(pairs.model.data(), pairs.count);
    const std::span measured(pairs.measured.data(), pairs.count);
    const RigidFit fit = fit_rigid(model, measured);
    out.reason = fit.reason;
    if (fit.reason != Reason::none) continue;
    out.T_camera_tool = fit.transform;
    out.rms_m = fit.rms_m;
    out.marker_mask = pairs.mask;
    const auto covariances = covariances_of(pairs, noise);
    const Result<Matrix6> covariance = fit_covariance(
        measured, std::span(covariances.data(), pairs.count), fit.transform * set.items[i].tip_m);
    out.reason = covariance.reason;
    out.covariance = covariance.value;
  }
}

}  // namespace glint
