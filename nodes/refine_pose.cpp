#include "nodes/refine_pose.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "kernels/pose/chi_square_limit.hpp"

namespace glint {
namespace {

// The labelled markers, weighed, and which of the tool's each is.
struct SeenMarkers {
  std::array<WeightedMarker, k_markers_per_tool_max> items;
  std::array<int, k_markers_per_tool_max> of_tool{};
  std::size_t count = 0;
  Reason reason = Reason::none;
};

SeenMarkers weigh(const Tool& tool, int marker_count, const Markers& markers,
                  const Labeling& labeling, const MarkerNoise& noise) {
  SeenMarkers out;
  for (int i = 0; i < marker_count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (labeling.marker[at] < 0) continue;
    const Marker& marker = markers.items[static_cast<std::size_t>(labeling.marker[at])];
    const double range_m = marker.surface_range_m + tool.centre_offset_m();
    const MarkerSight sight = sight_of(marker, range_m, noise);
    const Result<WeightedMarker> weighed =
        weigh_marker(tool.markers_m[at], sight.rays, range_m, sight.variance);
    if (!weighed) out.reason = weighed.reason;
    out.items[out.count] = weighed.value;
    out.of_tool[out.count++] = i;
  }
  return out;
}

// Markers that strays or a hand half hide are off by more than their noise, several at once, and
// no fit without one of them helps. As long as four times the declared sigmas would do, the pose
// counts with its covariance grown to what the residuals show (Birge 1932, The calculation of
// errors by the method of least squares); a wrong name is off by far more.
constexpr double k_noise_stretch_most = 16;

// What three markers agree on, or what had to be forgiven to agree, may be strays: it counts only
// where the followed motion explains it, too, and the less it was expected, the less it counts
// (Birge again): strays that agree time after time would else lead the motion away with them.
constexpr std::size_t k_agree_by_chance_most = 3;
constexpr double k_surprise_usual = 6;
constexpr double k_surprise_most = chi_square_limit(6);

}  // namespace

void RefinePose::fit(const Tool& tool, const Markers& markers, const Labeling& labeling,
                     const Prediction& prediction, FittedTool& out) noexcept {
  const SeenMarkers seen = weigh(tool, markers_within(tool, limits), markers, labeling, noise);
  out.reason = seen.reason;
  if (out.reason != Reason::none) return;
  constexpr RefineSettings k_most;
  const RefineSettings within = {
      std::min(settings.steps_max, k_most.steps_max), settings.left_out_max,
      std::min(settings.left_out_steps_max, k_most.left_out_steps_max),
      labeling.predicted_worth_m2 > 0 ? k_predicted_left_least : k_most.markers_left_least};
  const ExpectedPose expected = {prediction.T_camera_tool, prediction.covariance, tool.middle_m()};
  const RefinedPose pose = refine_pose({seen.items.data(), seen.count}, tool.tip_m, nullptr, within,
                                       prediction.follows_motion ? &expected : nullptr);
  counts_[2] += pose.work.fits;
  counts_[3] += pose.work.steps;
  counts_[4] += pose.work.marker_steps;
  const bool stretched = pose.reason == Reason::bad_fit &&
                         pose.chi_square <= k_noise_stretch_most * pose.degrees_of_freedom;
  out.reason = stretched ? Reason::none : pose.reason;
  if (out.reason != Reason::none) return;
  Matrix6 covariance = pose.covariance;
  if (stretched) covariance *= pose.chi_square / pose.degrees_of_freedom;
  const bool weak = stretched || pose.left_out >= 0 || seen.count <= k_agree_by_chance_most;
  if (weak && prediction.follows_motion) {
    const double surprise = surprise_of(expected, pose.T_camera_tool, covariance, tool.tip_m);
    if (surprise > k_surprise_most) {
      out.reason = Reason::bad_fit;
      return;
    }
    covariance *= std::max(1.0, surprise / k_surprise_usual);
  }
  out.covariance = covariance;
  double squares = 0;
  int kept = 0;
  for (std::size_t i = 0; i < seen.count; ++i) {
    if (static_cast<int>(i) == pose.left_out) continue;
    const WeightedMarker& marker = seen.items[i];
    squares += (pose.T_camera_tool * marker.model_m - marker.measured_m()).squaredNorm();
    out.marker_mask = static_cast<std::uint8_t>(out.marker_mask | (1u << seen.of_tool[i]));
    ++kept;
  }
  out.rms_m = std::sqrt(squares / kept);
  out.T_camera_tool = correct_bias(correction, pose.T_camera_tool).T_camera_tool;
}

void RefinePose::operator()(const FrameVerdict& verdict, const Markers& markers,
                            const graph::Latest<ToolSet>& tools, const Predictions& predictions,
                            const Assignment& assignment, graph::Slice slice,
                            FittedTools& fitted) noexcept {
  counts_ = {{1}};
  const ToolSet& set = tools.value();
  const int count = tools_within(set, limits);
  for (int t = slice.index; t < count; t += slice.count) {
    ++counts_[1];
    const auto i = static_cast<std::size_t>(t);
    FittedTool& out = fitted.tools[i];
    out = FittedTool{};
    out.reason = verdict.usable() ? assignment.reason[i] : verdict.reason;
    if (out.reason == Reason::none)
      fit(set.items[i], markers, assignment.labeling[i], predictions.tools[i], out);
  }
}

}  // namespace glint
