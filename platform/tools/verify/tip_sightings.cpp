#include "platform/tools/verify/tip_sightings.hpp"

#include <optional>
#include <utility>

#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/marker_slopes.hpp"
#include "kernels/pose/normal_equations.hpp"
#include "kernels/pose/refine_pose.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/session/calibration_watch.hpp"
#include "platform/runtime/session/labelled_markers.hpp"

namespace glint {
namespace {

struct FittedTip {
  Pose T_camera_tool;
  Matrix6 covariance;  // of the tip
};

std::optional<FittedTip> fit_of(const FittedTool& fitted, const LabelledMarkers& seen,
                                const Tool& tool) {
  if (fitted.reason == Reason::none && !fitted.ambiguous())
    return FittedTip{fitted.T_camera_tool, fitted.covariance};
  if (fitted.reason != Reason::bad_fit) return std::nullopt;
  const RefinedPose refined = refine_pose(seen.weighted(), tool.tip_m);
  if (refined.reason != Reason::none && refined.reason != Reason::bad_fit) return std::nullopt;
  return FittedTip{refined.T_camera_tool, refined.covariance};
}

// Adds the tip's derivatives: N^-1 h of all markers, transferred to the tip and rotated by
// `R_world_camera`.
bool add_slopes(const LabelledMarkers& seen, const Pose& pose, const Tool& tool,
                const CameraUncertainty& camera, const Matrix3& R_world_camera,
                TipObservation& observation) {
  const auto markers = seen.weighted();
  if (markers.size() < 3) return false;
  const Vector3 mean_m = mean_of(markers);
  NormalEquations normal;
  if (!add_markers(markers, pose, mean_m, normal)) return false;
  const Result<PoseFactor> factor = pose_factor(normal.matrix);
  if (!factor) return false;
  const Eigen::Matrix<double, 3, 6> tip_by_pull =
      R_world_camera * point_by_pose(pose.rotation * (tool.tip_m - mean_m)) *
      factor.value.inverse();
  const Matrix3 rotation = pose.rotation.toRotationMatrix();
  for (std::size_t i = 0; i < markers.size(); ++i) {
    const WeightedMarker& marker = markers[i];
    const MarkerSensitivity slopes = marker_sensitivity(
        marker, seen.sights()[i], pose * marker.model_m, pose.rotation * (marker.model_m - mean_m));
    const auto column = [&](const Vector6& pull) -> Vector3 { return tip_by_pull * pull; };
    TipByCalibration& by = observation.by_calibration;
    by.col(0) += column(slopes.by_range * camera.range_offset_m);
    by.col(1) += column(slopes.by_range * (camera.range_scale * marker.range_m));
    by.col(2) += column(slopes.by_pixel_x * camera.principal_point_px);
    by.col(3) += column(slopes.by_pixel_y * camera.principal_point_px);
    by.col(4) += column(slopes.by_focal * camera.focal_scale);
    const int number = seen.marker_indices()[i];
    by.middleCols<3>(k_common_errors + 3 * number) =
        tool.marker_sigma_m * (tip_by_pull * slopes.by_position * rotation);
    observation.by_markers.middleCols<3>(3 * number) << column(slopes.by_range),
        column(slopes.by_pixel_x), column(slopes.by_pixel_y);
    observation.range_m += marker.range_m / static_cast<double>(markers.size());
  }
  return true;
}

// Adds the headset's declared error, without correction by a reference body.
void add_head(const Pose& T_world_camera, const HeadErrorProcess& walk, const HeadNoise& head,
              TipObservation& observation) {
  const Vector3 pivot = T_world_camera * Vector3(0, 0, head.pivot_m);
  observation.by_head = point_by_pose(observation.tip_m - pivot);
  observation.by_head.leftCols<3>() *= head.rest_position_m;
  observation.by_head.rightCols<3>() *= head.rest_angle_rad;
  observation.motion_covariance_m2 =
      walk.transition_over(0, observation.tip_m, head).stationary_covariance.topLeftCorner<3, 3>() -
      observation.by_head * observation.by_head.transpose();
}

// Removes markers that the fit rejected; a rejected fit keeps all of its markers.
Labeling used_by(const FittedTool& fitted, Labeling labeling) {
  if (fitted.reason != Reason::none) return labeling;
  for (std::size_t i = 0; i < labeling.marker.size(); ++i)
    if (((fitted.marker_mask >> i) & 1) == 0) labeling.marker[i] = -1;
  return labeling;
}

std::optional<TipObservation> observation_of(const ArrivedFrame& arrived, const Tracker& tracker,
                                             const HeadErrorProcess& walk, const Cell& cell,
                                             std::size_t at) {
  const Assignment& assignment = tracker.token<Assignment>();
  if (assignment.reason[at] != Reason::none) return std::nullopt;
  const int slice = static_cast<int>(at) % k_tool_partitions;
  const FittedTool& fitted = tracker.parts<FittedTools>(slice).tools[at];
  const Tool& tool = cell.tools.items[at];
  const Labeling labeling = used_by(fitted, labeling_of(assignment, fitted, at));
  const LabelledMarkers seen(tracker.token<Markers>(), labeling, tool,
                             noise_of(tracker.token<Predictions>().noise, cell.camera), 0);
  const std::optional<FittedTip> fit = fit_of(fitted, seen, tool);
  if (!fit) return std::nullopt;
  const Pose base = arrived.head.valid ? arrived.head.T_world_camera : Pose{};
  const Matrix3 R_world_camera = base.rotation.toRotationMatrix();
  TipObservation observation;
  if (!add_slopes(seen, fit->T_camera_tool, tool, cell.camera.uncertainty, R_world_camera,
                  observation))
    return std::nullopt;
  observation.time = arrived.frame.mid_exposure;
  observation.rotation = base.rotation * fit->T_camera_tool.rotation;
  observation.tip_m = base * (fit->T_camera_tool * tool.tip_m);
  observation.centroid_m = base * (fit->T_camera_tool * tool.middle_m());
  observation.random_m2 =
      R_world_camera * fit->covariance.topLeftCorner<3, 3>() * R_world_camera.transpose();
  observation.rejected = fitted.reason != Reason::none;
  if (arrived.head.valid) add_head(arrived.head.T_world_camera, walk, cell.head_noise, observation);
  return observation;
}

}  // namespace

TipSeries observe_tips(RecordedFrames& recorded, std::size_t tool) {
  const Cell& cell = recorded.cell;
  TipSeries series;
  series.what = recorded.path;
  series.tool = cell.tools.items[tool];
  series.stated = {cell.camera.uncertainty, cell.camera.correlation, cell.head_noise,
                   series.tool.tip_sigma_m};
  std::vector<TipObservation> in_camera;
  CalibrationMonitor watch(cell);
  HeadErrorProcess walk;
  TrackedFrames tracked =
      track_frames(recorded, Search::tracked, [&](const ArrivedFrame& arrived, Tracker& tracker) {
        watch.add_frame(tracker);
        if (tracker.token<FrameVerdict>().resynchronised) walk.restart_clock();
        if (arrived.head.valid) (void)walk.observe(arrived.head, cell.head_noise);
        const auto observation = observation_of(arrived, tracker, walk, cell, tool);
        if (observation)
          (arrived.head.valid ? series.observations : in_camera).push_back(*observation);
      });
  series.frames = tracked.frames;
  series.failures = std::move(tracked.failures);
  series.residuals = watch.errors_of(tool);
  series.in_world = series.observations.size() >= in_camera.size();
  if (!series.in_world) series.observations = std::move(in_camera);
  for (const TipObservation& observation : series.observations)
    series.rejected += observation.rejected ? 1 : 0;
  if (series.observations.empty()) {
    throw InputError(series.what + ": the tool \"" + series.tool.name.data() +
                     "\" was found in none of " + std::to_string(series.frames) +
                     " frames; expected it in view: see `glint inspect --recording`");
  }
  return series;
}

}  // namespace glint
