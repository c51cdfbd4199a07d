#include "nodes/refine_pose.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "kernels/pose/blob_size.hpp"
#include "kernels/pose/chi_square_limit.hpp"
#include "kernels/pose/choose_hypothesis.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/map_pose.hpp"
#include "kernels/pose/marker_range.hpp"

namespace glint {
namespace {

// The labelled markers with their weights, and the index of each in the tool.
struct WeightedMarkers {
  std::array<WeightedMarker, k_markers_per_tool_max> items;
  std::array<MarkerVariance, k_markers_per_tool_max> variances;
  std::array<LocalRays, k_markers_per_tool_max> rays;
  std::array<int, k_markers_per_tool_max> of_tool{};
  std::array<bool, k_markers_per_tool_max> isolated{};  // neither merged nor partially occluded
  std::size_t count = 0;
  bool have_images = true;
  Reason reason = Reason::none;

  [[nodiscard]] std::size_t isolated_count() const {
    return static_cast<std::size_t>(std::count(isolated.begin(), isolated.begin() + count, true));
  }
};

WeightedMarkers without(const WeightedMarkers& seen, int removed) {
  WeightedMarkers kept = seen;
  if (removed < 0) return kept;
  const auto first = static_cast<std::size_t>(removed);
  --kept.count;
  for (std::size_t i = first; i < kept.count; ++i) {
    kept.items[i] = seen.items[i + 1];
    kept.variances[i] = seen.variances[i + 1];
    kept.rays[i] = seen.rays[i + 1];
    kept.of_tool[i] = seen.of_tool[i + 1];
    kept.isolated[i] = seen.isolated[i + 1];
  }
  return kept;
}

WeightedMarkers weight_markers(const Tool& tool, int marker_count, const Markers& markers,
                               const Labeling& labeling, const MarkerNoise& noise) {
  std::array<MarkerMeasurementModel, k_markers_per_tool_max> models;
  std::array<double, k_markers_per_tool_max> rim_offsets{};
  CommonRimOffset common;
  WeightedMarkers out;
  for (int i = 0; i < marker_count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (labeling.marker[at] < 0) continue;
    const Marker& marker = markers.items[static_cast<std::size_t>(labeling.marker[at])];
    WeightedMarker& seen = out.items[out.count];
    seen.model_m = tool.markers_m[at];
    seen.range_m = centre_range_m(marker, tool);
    models[out.count] = measurement_model(marker, seen.range_m, noise);
    rim_offsets[out.count] = rim_offset_px(marker, models[out.count].rays, tool, seen.range_m);
    common.add(rim_offsets[out.count]);
    out.have_images = out.have_images && marker.along_x.squaredNorm() > 0;
    out.isolated[out.count] = (marker.flags & k_marker_not_isolated) == 0;
    out.of_tool[out.count++] = i;
  }
  for (std::size_t i = 0; i < out.count; ++i) {
    const double own = common.beyond(rim_offsets[i]);
    out.isolated[i] = out.isolated[i] && !is_merged(own) && !is_partially_occluded(own);
    inflate(models[i].variance, own);
    const Result<WeightedMarker> weighed = whiten_marker(out.items[i].model_m, models[i].rays,
                                                         out.items[i].range_m, models[i].variance);
    if (!weighed) out.reason = weighed.reason;
    out.items[i] = weighed.value;
    out.variances[i] = models[i].variance;
    out.rays[i] = models[i].rays;
  }
  return out;
}

// Markers that are partially occluded or merged with stray reflections exceed their noise, often
// several at once; removing one of them does not help. Up to four times the declared sigmas, the
// pose is kept and its covariance scaled by the reduced chi-square. A wrong labeling has far larger
// residuals. Source: Birge 1932, The calculation of errors by the method of least squares.
constexpr double k_variance_inflation_max = 16;

// Three markers, an inflated fit or a fit with a removed marker may agree by chance on stray
// reflections. Such a pose counts only if it is consistent with the tracked motion; its covariance
// grows with its squared Mahalanobis distance (Birge again). Otherwise stray reflections that agree
// in successive frames would pull the track away.
constexpr std::size_t k_chance_agreement_max = 3;
constexpr double k_squared_distance_mean = 6;
constexpr double k_squared_distance_max = chi_square_limit(6);

// Chi-square barrier between the two minima of a flat tool, above which they are separate.
constexpr double k_barrier_min = 16;

// Penalty on the chi-square of a pose hypothesis with one removed marker.
constexpr double k_removal_penalty = chi_square_limit(3);

// A labeling with its weighted markers and its pose.
struct FittedLabeling {
  WeightedMarkers seen;
  RefinedPose pose;
};

// Adds both minima as pose hypotheses, the better one first. Chi-square is divided by
// `variance_factor`, the largest possible variance factor. Returns the number of hypotheses.
std::size_t add_hypotheses(const RefinedPose& pose, int labeling, double variance_factor,
                           std::span<PoseHypothesis> out) {
  const double cost = pose.rejected >= 0 ? k_removal_penalty : 0;
  const double limit = (cost + chi_square_limit(pose.degrees_of_freedom)) / variance_factor;
  const double first = (cost + pose.chi_square) / variance_factor;
  out[0] = {pose.T_camera_tool, pose.covariance, first, pose.mahalanobis_square, limit, labeling};
  if (!pose.other.exists) return 1;
  const OtherMinimum& other = pose.other;
  const double second = first + other.delta_chi_square / variance_factor;
  out[1] = {
      other.T_camera_tool, other.covariance, second, other.mahalanobis_square, limit, labeling};
  return 2;
}

bool is_fitted(const RefinedPose& pose) {
  return pose.reason == Reason::none || pose.reason == Reason::bad_fit;
}

}  // namespace

void RefinePose::fit(const Tool& tool, const Markers& markers, const Labeling& labeling,
                     const Labeling& alternative, const Prediction& prediction,
                     const MarkerNoise& now, double variance_factor, FittedTool& out) noexcept {
  std::array<FittedLabeling, 2> fits;
  fits[0].seen = weight_markers(tool, markers_within(tool, limits), markers, labeling, now);
  out.reason = fits[0].seen.reason;
  if (out.reason != Reason::none) return;
  constexpr RefineSettings k_defaults;
  RefineSettings within = {
      std::min(settings.steps_max, k_defaults.steps_max), settings.rejected_max,
      std::min(settings.rejection_steps_max, k_defaults.rejection_steps_max),
      labeling.log_prior_ratio_m2 > 0 ? k_predicted_markers_min : k_defaults.markers_kept_min};
  const PredictedPose expected = {prediction.T_camera_tool, prediction.covariance, tool.middle_m()};
  std::array<PoseHypothesis, 4> hypotheses;
  std::size_t count = 0;
  for (int k = 0; k < 2; ++k) {
    FittedLabeling& fitted = fits[static_cast<std::size_t>(k)];
    if (k == 1) {
      if (alternative.count == 0) break;
      within.rejected_max = 0;
      fitted.seen = weight_markers(tool, markers_within(tool, limits), markers, alternative, now);
      if (fitted.seen.reason != Reason::none) break;
    }
    fitted.pose = refine_pose({fitted.seen.items.data(), fitted.seen.count}, tool.tip_m, nullptr,
                              within, prediction.follows_motion ? &expected : nullptr);
    counts_[graph::loop_of<RefinePose>("fits")] += fitted.pose.work.fits;
    counts_[graph::loop_of<RefinePose>("steps")] += fitted.pose.work.steps;
    counts_[graph::loop_of<RefinePose>("marker_steps")] += fitted.pose.work.marker_steps;
    if (is_fitted(fitted.pose))
      count +=
          add_hypotheses(fitted.pose, k, variance_factor, std::span(hypotheses).subspan(count));
  }
  if (count == 0) {
    out.reason = fits[0].pose.reason;
    return;
  }
  const ChosenHypothesis chosen =
      choose_hypothesis({hypotheses.data(), count}, prediction.odds, tool.tip_m);
  const PoseHypothesis& hypothesis = hypotheses[static_cast<std::size_t>(chosen.index)];
  const FittedLabeling& best = fits[static_cast<std::size_t>(hypothesis.labeling)];
  const RefinedPose& pose = best.pose;
  const double chi_square =
      variance_factor * hypothesis.chi_square - (pose.rejected >= 0 ? k_removal_penalty : 0);
  out.odds = chosen.odds;
  out.contradicts_track = chosen.switched;
  out.by_alternative = hypothesis.labeling == 1;
  const bool followed = prediction.follows_motion && !chosen.switched && !chosen.unexpected;
  const WeightedMarkers kept = without(best.seen, pose.rejected);
  const std::span<const WeightedMarker> items = {kept.items.data(), kept.count};
  // If the barrier between the two minima is within the noise, the linear equations at the pose
  // between them hold for both.
  Pose facing;
  LinearisedPose between;
  bool shallow = false;
  if (pose.shallow) {
    facing = face_on_pose(items, hypothesis.T_camera_tool);
    between = linearised_pose(items, facing, tool.tip_m);
    shallow = between.reason == Reason::none && between.chi_square - chi_square < k_barrier_min;
  }
  // A rotation may be poorly observable; the fitted minimum then underestimates the covariance:
  // map_pose.hpp.
  MapPose agreed;
  if (followed && shallow) {
    const LinearisedPose of_middle = linearised_pose(items, facing, expected.reference_m);
    out.has_relinearised = true;
    out.relinearised_T_camera_tool = of_middle.T_camera_tool;
    out.relinearised_covariance = of_middle.covariance;
  } else if (followed && kept.isolated_count() <= k_chance_agreement_max) {
    agreed = map_pose(items, expected, within.steps_max);
    ++counts_[graph::loop_of<RefinePose>("fits")];
    counts_[graph::loop_of<RefinePose>("steps")] += agreed.steps;
    counts_[graph::loop_of<RefinePose>("marker_steps")] +=
        agreed.steps * static_cast<int>(kept.count);
    out.has_relinearised = agreed.reason == Reason::none;
    out.relinearised_T_camera_tool = agreed.T_camera_tool;
    out.relinearised_covariance = agreed.covariance;
  }
  if (kept.have_images) {
    out.residuals =
        residuals_of(items, {kept.variances.data(), kept.count}, hypothesis.T_camera_tool, now);
    counts_[graph::loop_of<RefinePose>("steps")] += k_residual_steps;
    counts_[graph::loop_of<RefinePose>("marker_steps")] +=
        k_residual_steps * static_cast<int>(kept.count);
  }
  const Pose published_pose = shallow ? between.T_camera_tool : hypothesis.T_camera_tool;
  // A point without an image comes from another tracker: camera errors do not apply.
  const Result<SystematicCovariance> systematic =
      systematic_covariance(items, {kept.rays.data(), kept.count}, published_pose, tool.middle_m(),
                            kept.have_images ? uncertainty : k_exact_camera, tool.marker_sigma_m);
  counts_[graph::loop_of<RefinePose>("steps")] += k_systematic_steps;
  counts_[graph::loop_of<RefinePose>("marker_steps")] +=
      k_systematic_steps * static_cast<int>(kept.count);
  out.systematic = systematic.value;
  out.reason = systematic.reason;
  if (out.reason != Reason::none) return;
  // Tests the chosen minimum, not the likelier one of both.
  const bool passes_test = chi_square <= chi_square_limit(pose.degrees_of_freedom);
  const bool is_inflated =
      !passes_test && chi_square <= k_variance_inflation_max * pose.degrees_of_freedom;
  out.reason = passes_test || is_inflated ? Reason::none : Reason::bad_fit;
  if (out.reason != Reason::none) return;
  double inflation = is_inflated ? chi_square / pose.degrees_of_freedom : 1.0;
  // The noise is larger by that much, also than the doubt that chi-square was divided by: the odds
  // are smaller. A motion that follows one hypothesis is evidence of its own.
  if (!followed) out.odds /= std::max(1.0, inflation / variance_factor);
  const bool weak =
      is_inflated || pose.rejected >= 0 || kept.isolated_count() <= k_chance_agreement_max;
  // Markers and motion may each pass their own test and fail the joint test. Four markers, some of
  // them partially occluded, may also agree by chance: one such frame does not end a motion whose
  // odds are settled.
  const bool contradicts =
      out.has_relinearised && !shallow &&
      agreed.chi_square > inflation * chi_square_limit(3 * static_cast<int>(kept.count));
  const bool by_chance = chosen.unexpected && prediction.odds >= k_odds_min &&
                         (weak || kept.count <= k_chance_agreement_max + 1);
  if (contradicts || by_chance) {
    out.reason = Reason::bad_fit;
    return;
  }
  if (weak && followed) {
    const double squared_distance =
        out.has_relinearised
            ? mahalanobis_square(expected, out.relinearised_T_camera_tool,
                                 inflation * out.relinearised_covariance, expected.reference_m)
            : mahalanobis_square(expected, hypothesis.T_camera_tool,
                                 inflation * hypothesis.covariance, tool.tip_m);
    if (squared_distance > k_squared_distance_max) {
      out.reason = Reason::bad_fit;
      return;
    }
    inflation *= std::max(1.0, squared_distance / k_squared_distance_mean);
  }
  out.covariance = shallow ? between.covariance : hypothesis.covariance;
  out.covariance *= inflation;
  out.relinearised_covariance *= inflation;
  double squares = 0;
  for (std::size_t i = 0; i < kept.count; ++i) {
    const WeightedMarker& marker = kept.items[i];
    squares += (published_pose * marker.model_m - marker.measured_m()).squaredNorm();
    out.marker_mask = static_cast<std::uint8_t>(out.marker_mask | (1u << kept.of_tool[i]));
  }
  out.rms_m = std::sqrt(squares / static_cast<double>(kept.count));
  out.T_camera_tool = correct_bias(correction, published_pose).T_camera_tool;
  out.relinearised_T_camera_tool =
      correct_bias(correction, out.relinearised_T_camera_tool).T_camera_tool;
}

void RefinePose::operator()(const FrameVerdict& verdict, const Markers& markers,
                            const graph::Latest<ToolSet>& tools, const Predictions& predictions,
                            const Assignment& assignment, graph::Partition partition,
                            FittedTools& fitted) noexcept {
  counts_ = {{1}};
  const ToolSet& set = tools.value();
  const int count = tools_within(set, limits);
  for (int t = partition.index; t < count; t += partition.count) {
    ++counts_[graph::loop_of<RefinePose>("tools")];
    const auto i = static_cast<std::size_t>(t);
    FittedTool& out = fitted.tools[i];
    out = FittedTool{};
    out.reason = verdict.usable() ? assignment.reason[i] : verdict.reason;
    if (out.reason == Reason::none)
      fit(set.items[i], markers, assignment.labeling[i], assignment.alternative[i],
          predictions.tools[i], noise_now(predictions.noise, noise),
          estimate_noise ? variance_inflation(predictions.noise, noise) : 1.0, out);
  }
}

}  // namespace glint
