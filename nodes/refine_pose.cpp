#include "nodes/refine_pose.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "kernels/pose/agreed_pose.hpp"
#include "kernels/pose/blob_size.hpp"
#include "kernels/pose/chi_square_limit.hpp"
#include "kernels/pose/choose_reading.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/marker_range.hpp"

namespace glint {
namespace {

// The labelled markers with their weights, and the index of each in the tool.
struct SeenMarkers {
  std::array<WeightedMarker, k_markers_per_tool_max> items;
  std::array<MarkerVariance, k_markers_per_tool_max> variances;
  std::array<LocalRays, k_markers_per_tool_max> rays;
  std::array<int, k_markers_per_tool_max> of_tool{};
  std::array<bool, k_markers_per_tool_max> whole{};  // neither merged nor partially occluded
  std::size_t count = 0;
  bool have_images = true;
  Reason reason = Reason::none;

  [[nodiscard]] std::size_t whole_count() const {
    return static_cast<std::size_t>(std::count(whole.begin(), whole.begin() + count, true));
  }
};

SeenMarkers without(const SeenMarkers& seen, int left_out) {
  SeenMarkers kept = seen;
  if (left_out < 0) return kept;
  const auto first = static_cast<std::size_t>(left_out);
  --kept.count;
  for (std::size_t i = first; i < kept.count; ++i) {
    kept.items[i] = seen.items[i + 1];
    kept.variances[i] = seen.variances[i + 1];
    kept.rays[i] = seen.rays[i + 1];
    kept.of_tool[i] = seen.of_tool[i + 1];
    kept.whole[i] = seen.whole[i + 1];
  }
  return kept;
}

SeenMarkers weigh(const Tool& tool, int marker_count, const Markers& markers,
                  const Labeling& labeling, const MarkerNoise& noise) {
  std::array<MarkerSight, k_markers_per_tool_max> sights;
  std::array<double, k_markers_per_tool_max> strips{};
  CommonStrip common;
  SeenMarkers out;
  for (int i = 0; i < marker_count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (labeling.marker[at] < 0) continue;
    const Marker& marker = markers.items[static_cast<std::size_t>(labeling.marker[at])];
    WeightedMarker& seen = out.items[out.count];
    seen.model_m = tool.markers_m[at];
    seen.range_m = centre_range_m(marker, tool);
    sights[out.count] = sight_of(marker, seen.range_m, noise);
    strips[out.count] = strip_px(marker, sights[out.count].rays, tool, seen.range_m);
    common.add(strips[out.count]);
    out.have_images = out.have_images && marker.along_x.squaredNorm() > 0;
    out.whole[out.count] = (marker.flags & k_marker_uneven) == 0;
    out.of_tool[out.count++] = i;
  }
  for (std::size_t i = 0; i < out.count; ++i) {
    const double own = common.beyond(strips[i]);
    out.whole[i] = out.whole[i] && !is_merged(own) && !is_partly_hidden(own);
    widen(sights[i].variance, own);
    const Result<WeightedMarker> weighed = weigh_marker(out.items[i].model_m, sights[i].rays,
                                                        out.items[i].range_m, sights[i].variance);
    if (!weighed) out.reason = weighed.reason;
    out.items[i] = weighed.value;
    out.variances[i] = sights[i].variance;
    out.rays[i] = sights[i].rays;
  }
  return out;
}

// Markers that are partially occluded or merged with stray reflections exceed their noise, often
// several at once; removing one of them does not help. Up to four times the declared sigmas, the
// pose is kept and its covariance scaled by the reduced chi-square. A wrong labeling has far larger
// residuals. Source: Birge 1932, The calculation of errors by the method of least squares.
constexpr double k_noise_stretch_most = 16;

// Three markers, an inflated fit or a fit with a removed marker may agree by chance on stray
// reflections. Such a pose counts only if it is consistent with the tracked motion; its covariance
// grows with its squared Mahalanobis distance (Birge again). Otherwise stray reflections that agree
// in successive frames would pull the track away.
constexpr std::size_t k_agree_by_chance_most = 3;
constexpr double k_surprise_usual = 6;
constexpr double k_surprise_most = chi_square_limit(6);

// Chi-square barrier between the two minima of a flat tool, above which they are separate.
constexpr double k_wall_least = 16;

// Penalty on the chi-square of a pose hypothesis with one removed marker.
constexpr double k_left_out_cost = chi_square_limit(3);

// A labeling with its weighted markers and its pose.
struct FittedLabeling {
  SeenMarkers seen;
  RefinedPose pose;
};

// Adds both minima as pose hypotheses, the better one first. Chi-square is divided by `doubt`, the
// largest possible variance factor. Returns the number of hypotheses.
std::size_t add_readings(const RefinedPose& pose, int labeling, double doubt,
                         std::span<PoseReading> out) {
  const double cost = pose.left_out >= 0 ? k_left_out_cost : 0;
  const double most = (cost + chi_square_limit(pose.degrees_of_freedom)) / doubt;
  const double first = (cost + pose.chi_square) / doubt;
  out[0] = {pose.T_camera_tool, pose.covariance, first, pose.surprise, most, labeling};
  if (!pose.other.exists) return 1;
  const OtherMinimum& other = pose.other;
  const double second = first + other.delta_chi_square / doubt;
  out[1] = {other.T_camera_tool, other.covariance, second, other.surprise, most, labeling};
  return 2;
}

bool is_fitted(const RefinedPose& pose) {
  return pose.reason == Reason::none || pose.reason == Reason::bad_fit;
}

}  // namespace

void RefinePose::fit(const Tool& tool, const Markers& markers, const Labeling& labeling,
                     const Labeling& rival, const Prediction& prediction, const MarkerNoise& now,
                     double doubt, FittedTool& out) noexcept {
  std::array<FittedLabeling, 2> fits;
  fits[0].seen = weigh(tool, markers_within(tool, limits), markers, labeling, now);
  out.reason = fits[0].seen.reason;
  if (out.reason != Reason::none) return;
  constexpr RefineSettings k_most;
  RefineSettings within = {
      std::min(settings.steps_max, k_most.steps_max), settings.left_out_max,
      std::min(settings.left_out_steps_max, k_most.left_out_steps_max),
      labeling.predicted_worth_m2 > 0 ? k_predicted_left_least : k_most.markers_left_least};
  const ExpectedPose expected = {prediction.T_camera_tool, prediction.covariance, tool.middle_m()};
  std::array<PoseReading, 4> readings;
  std::size_t count = 0;
  for (int k = 0; k < 2; ++k) {
    FittedLabeling& fitted = fits[static_cast<std::size_t>(k)];
    if (k == 1) {
      if (rival.count == 0) break;
      within.left_out_max = 0;
      fitted.seen = weigh(tool, markers_within(tool, limits), markers, rival, now);
      if (fitted.seen.reason != Reason::none) break;
    }
    fitted.pose = refine_pose({fitted.seen.items.data(), fitted.seen.count}, tool.tip_m, nullptr,
                              within, prediction.follows_motion ? &expected : nullptr);
    counts_[2] += fitted.pose.work.fits;
    counts_[3] += fitted.pose.work.steps;
    counts_[4] += fitted.pose.work.marker_steps;
    if (is_fitted(fitted.pose))
      count += add_readings(fitted.pose, k, doubt, std::span(readings).subspan(count));
  }
  if (count == 0) {
    out.reason = fits[0].pose.reason;
    return;
  }
  const ChosenReading chosen =
      choose_reading({readings.data(), count}, prediction.odds, tool.tip_m);
  const PoseReading& reading = readings[static_cast<std::size_t>(chosen.index)];
  const FittedLabeling& best = fits[static_cast<std::size_t>(reading.labeling)];
  const RefinedPose& pose = best.pose;
  const double chi_square = doubt * reading.chi_square - (pose.left_out >= 0 ? k_left_out_cost : 0);
  out.odds = chosen.odds;
  out.turned = chosen.turned;
  out.by_rival = reading.labeling == 1;
  const bool followed = prediction.follows_motion && !chosen.turned && !chosen.unexpected;
  const SeenMarkers kept = without(best.seen, pose.left_out);
  const std::span<const WeightedMarker> items = {kept.items.data(), kept.count};
  // If the barrier between the two minima is within the noise, the linear equations at the pose
  // between them hold for both.
  Pose facing;
  NearPose between;
  bool shallow = false;
  if (pose.shallow) {
    facing = face_on(items, reading.T_camera_tool);
    between = near_pose(items, facing, tool.tip_m);
    shallow = between.reason == Reason::none && between.chi_square - chi_square < k_wall_least;
  }
  // A rotation may be poorly observable; the fitted minimum then underestimates the covariance:
  // agreed_pose.hpp.
  AgreedPose agreed;
  if (followed && shallow) {
    const NearPose of_middle = near_pose(items, facing, expected.reference_m);
    out.tells_near = true;
    out.near_T_camera_tool = of_middle.T_camera_tool;
    out.near_covariance = of_middle.covariance;
  } else if (followed && kept.whole_count() <= k_agree_by_chance_most) {
    agreed = agreed_pose(items, expected, within.steps_max);
    ++counts_[2];
    counts_[3] += agreed.steps;
    counts_[4] += agreed.steps * static_cast<int>(kept.count);
    out.tells_near = agreed.reason == Reason::none;
    out.near_T_camera_tool = agreed.T_camera_tool;
    out.near_covariance = agreed.covariance;
  }
  if (kept.have_images) {
    out.residuals =
        residuals_of(items, {kept.variances.data(), kept.count}, reading.T_camera_tool, now);
    counts_[3] += k_residual_steps;
    counts_[4] += k_residual_steps * static_cast<int>(kept.count);
  }
  const Pose shown = shallow ? between.T_camera_tool : reading.T_camera_tool;
  // A point without an image comes from another tracker: camera errors do not apply.
  const Result<SystematicCovariance> systematic =
      systematic_covariance(items, {kept.rays.data(), kept.count}, shown, tool.middle_m(),
                            kept.have_images ? uncertainty : k_exact_camera, tool.marker_sigma_m);
  counts_[3] += k_systematic_steps;
  counts_[4] += k_systematic_steps * static_cast<int>(kept.count);
  out.systematic = systematic.value;
  out.reason = systematic.reason;
  if (out.reason != Reason::none) return;
  // Tests the chosen minimum, not the likelier one of both.
  const bool explained = chi_square <= chi_square_limit(pose.degrees_of_freedom);
  const bool stretched = !explained && chi_square <= k_noise_stretch_most * pose.degrees_of_freedom;
  out.reason = explained || stretched ? Reason::none : Reason::bad_fit;
  if (out.reason != Reason::none) return;
  double growth = stretched ? chi_square / pose.degrees_of_freedom : 1.0;
  const bool weak = stretched || pose.left_out >= 0 || kept.whole_count() <= k_agree_by_chance_most;
  // Markers and motion may each pass their own test and fail the joint test. Four markers, some of
  // them partially occluded, may also agree by chance: one such frame does not end a motion whose
  // odds are settled.
  const bool contradicts =
      out.tells_near && !shallow &&
      agreed.chi_square > growth * chi_square_limit(3 * static_cast<int>(kept.count));
  const bool by_chance = chosen.unexpected && prediction.odds >= k_odds_least &&
                         (weak || kept.count <= k_agree_by_chance_most + 1);
  if (contradicts || by_chance) {
    out.reason = Reason::bad_fit;
    return;
  }
  if (weak && followed) {
    const double surprise =
        out.tells_near
            ? surprise_of(expected, out.near_T_camera_tool, growth * out.near_covariance,
                          expected.reference_m)
            : surprise_of(expected, reading.T_camera_tool, growth * reading.covariance, tool.tip_m);
    if (surprise > k_surprise_most) {
      out.reason = Reason::bad_fit;
      return;
    }
    growth *= std::max(1.0, surprise / k_surprise_usual);
  }
  out.covariance = shallow ? between.covariance : reading.covariance;
  out.covariance *= growth;
  out.near_covariance *= growth;
  double squares = 0;
  for (std::size_t i = 0; i < kept.count; ++i) {
    const WeightedMarker& marker = kept.items[i];
    squares += (shown * marker.model_m - marker.measured_m()).squaredNorm();
    out.marker_mask = static_cast<std::uint8_t>(out.marker_mask | (1u << kept.of_tool[i]));
  }
  out.rms_m = std::sqrt(squares / static_cast<double>(kept.count));
  out.T_camera_tool = correct_bias(correction, shown).T_camera_tool;
  out.near_T_camera_tool = correct_bias(correction, out.near_T_camera_tool).T_camera_tool;
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
      fit(set.items[i], markers, assignment.labeling[i], assignment.rival[i], predictions.tools[i],
          noise_now(predictions.noise, noise),
          estimate_noise ? variance_doubt(predictions.noise, noise) : 1.0, out);
  }
}

}  // namespace glint
