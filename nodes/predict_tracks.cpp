#include "nodes/predict_tracks.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/elementary.hpp"
#include "kernels/motion/predict_motion.hpp"
#include "kernels/pose/lever_arm.hpp"

namespace glint {
namespace {

// Extends the predicted bounding box by one marker, dilated by the tool's reach.
void include(const CameraModel& camera, const Tool& tool, const Vector3& point,
             const Vector2& pixel, Prediction& prediction) {
  const double radius_px =
      camera.fx * (prediction.reach_m + 2 * tool.marker_radius_m) / std::max(point.z(), 0.05);
  // Not Eigen's cwiseMin: it passes a function pointer, whose effects the compiler cannot check.
  for (int axis = 0; axis < 2; ++axis) {
    prediction.low_px[axis] = std::min(prediction.low_px[axis], pixel[axis] - radius_px);
    prediction.high_px[axis] = std::max(prediction.high_px[axis], pixel[axis] + radius_px);
  }
}

// While only parts of the frame are searched, the whole frame is tried every k_whole_frame_period
// frames: the cause of the excess runs may be gone.
constexpr std::uint32_t k_whole_frame_period = 16;

// Variance of the change of a first-order Gauss-Markov process within a time, relative to its
// stationary variance.
double relative_change_variance(double seconds, double correlation_s) {
  return correlation_s > 0 ? 2 * (1 - exponential(-seconds / correlation_s)) : 2.0;
}

bool speed_is_estimated(const MotionState& motion, double sigma_m_s) {
  for (int axis = k_velocity; axis < k_velocity + 3; ++axis) {
    if (!(motion.covariance(axis, axis) <= sigma_m_s * sigma_m_s)) return false;
  }
  return true;
}

}  // namespace

// T_camera_world is null without a head pose.
PredictTracks::PredictedMotion PredictTracks::predict_track(const Track& track, const Tool& tool,
                                                            Time time,
                                                            const HeadDriftCorrection& anchor,
                                                            const Pose* T_camera_world,
                                                            Prediction& prediction) noexcept {
  const bool in_world = track.base == ReferenceFrame::world;
  prediction.has_prior = true;
  prediction.undetected_last = !track.measured_now;
  prediction.follows_motion = !in_world || T_camera_world != nullptr;
  if (!prediction.follows_motion) {
    prediction.T_camera_tool = track.T_camera_tool;  // kept at its last pose in the camera frame
    return {};
  }
  ++counts_[graph::loop_of<PredictTracks>("moving")];
  prediction.within_reach_only = speed_is_estimated(track.motion, settings.speed_sigma_max_m_s);
  const UncertainPose later = predict_pose(track.motion, time, settings.motion, track.noise);
  const bool goes_on = time - track.motion.time <= settings.horizon;
  Pose middle = goes_on ? later.pose : track.motion.pose;
  prediction.covariance = track.nis_ratio * later.covariance;
  prediction.odds = track.odds;
  PredictedMotion predicted_motion;
  predicted_motion.hold_distance_m = (later.pose.translation - middle.translation).norm();
  if (in_world) {
    const double since_s = (time - track.newest.time).seconds();
    const Matrix6 of_head = relative_change_variance(since_s, settings.head_correlation_s) *
                            anchor.uncorrected_covariance_at(middle.translation);
    predicted_motion.head_sigma_m = std::sqrt(largest_variance(of_head.topLeftCorner<3, 3>()));
    prediction.covariance += of_head;
    prediction.covariance = rotated_covariance(prediction.covariance, T_camera_world->rotation);
    middle = *T_camera_world * middle;
  }
  prediction.T_camera_tool = {middle.rotation, middle * (-tool.middle_m())};
  return predicted_motion;
}

// Bounded by the motion of a hand in the world and of the world relative to the headset.
double PredictTracks::reach_of(const Prediction& prediction, const Tool& tool, int markers,
                               double seconds,
                               const PredictedMotion& predicted_motion) const noexcept {
  const double half_jerk = 0.5 * settings.acceleration_max_m_s2;
  const double reach_max = settings.margin_m + settings.speed_max_m_s * seconds +
                           half_jerk * seconds * seconds +
                           k_reach_sigmas * predicted_motion.head_sigma_m;
  if (!prediction.follows_motion) return reach_max;
  double variance = 0;
  const Vector3 middle = tool.middle_m();
  for (int m = 0; m < markers; ++m) {
    const Vector3 lever = tool.markers_m[static_cast<std::size_t>(m)] - middle;
    variance = std::max(variance, largest_variance(prediction.marker_position_covariance(lever)));
  }
  const double start_s = std::min(seconds, settings.start_max.seconds());
  const double reach_min = settings.reach_min_m + half_jerk * start_s * start_s;
  return std::clamp(predicted_motion.hold_distance_m + k_reach_sigmas * std::sqrt(variance),
                    reach_min, reach_max);
}

void PredictTracks::operator()(const FrameVerdict& verdict, const HeadPose& head,
                               const graph::Latest<ToolSet>& tools,
                               const graph::Previous<Anchor>& anchor,
                               const graph::Previous<Estimates>& last,
                               Predictions& predictions) noexcept {
  // Uses the previous frame's drift correction: this frame's depends on tools not yet detected.
  const Pose T_camera_world = anchor.value().state.corrected(head.T_world_camera).inverse();
  predictions.marker_count = 0;
  predictions.frame_number = verdict.accepted;
  predictions.noise = last.value().noise;
  counts_ = {{1}};
  int lens_steps = 0, searched_everywhere = 0, cut_short = 0;
  const ToolSet& set = tools.value();
  const int count = tools_within(set, limits);
  for (int t = 0; t < k_tools_max; ++t) {
    Prediction& prediction = predictions.tools[t];
    prediction = Prediction{};
    const bool present = t < count && verdict.usable() && set.items[t].present();
    searched_everywhere += present ? 1 : 0;
    cut_short += present && last.value().tracks[t].reason == Reason::runs_full ? 1 : 0;
    if (t >= count || !verdict.usable() || verdict.resynchronised) continue;
    const Track& track = last.value().tracks[t];
    if (!track.alive || track.identity != set.items[t].identity) continue;
    const Time now = verdict.stamp.mid_exposure;
    const Duration gap = now - track.newest.time;
    if (gap > settings.lost_after) continue;

    ++counts_[graph::loop_of<PredictTracks>("tools")];
    const Tool& tool = set.items[t];
    const PredictedMotion predicted_motion = predict_track(
        track, tool, now, anchor.value().state, head.valid ? &T_camera_world : nullptr, prediction);
    const int markers = markers_within(tool, limits);
    prediction.reach_m = reach_of(prediction, tool, markers, gap.seconds(), predicted_motion);
    counts_[graph::loop_of<PredictTracks>("markers")] += markers;
    prediction.in_view = true;
    prediction.low_px = Vector2::Constant(1e9);
    prediction.high_px = Vector2::Constant(-1e9);
    for (int m = 0; m < markers; ++m) {
      const Vector3 point = prediction.T_camera_tool * tool.markers_m[m];
      const Result<Vector2> pixel = project(camera, point, lens_steps);
      prediction.in_view = prediction.in_view && pixel.reason == Reason::none;
      if (!pixel) continue;
      predictions.markers_px[predictions.marker_count++] = pixel.value;
      include(camera, tool, point, pixel.value, prediction);
    }
    searched_everywhere -= present && prediction.in_view && !prediction.undetected_last ? 1 : 0;
  }
  predictions.search_whole_frame = searched_everywhere > 0;
  predictions.search_part_of_frame =
      cut_short > 0 && predictions.frame_number % k_whole_frame_period != 0;
  counts_[graph::loop_of<PredictTracks>("lens_steps")] = lens_steps;
}

}  // namespace glint
