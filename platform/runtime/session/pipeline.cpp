#include "platform/runtime/session/pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace glint {
namespace {

// Radii of the smallest and largest marker of all tools; the size gate must accept both.
struct RadiusRange {
  double smallest_m = 0.005, largest_m = 0.005;
};

RadiusRange radii(const ToolSet& tools) {
  RadiusRange range;
  for (int t = 0; t < tools.count; ++t) {
    const double radius = tools.items[static_cast<std::size_t>(t)].marker_radius_m;
    range.smallest_m = t == 0 ? radius : std::min(range.smallest_m, radius);
    range.largest_m = t == 0 ? radius : std::max(range.largest_m, radius);
  }
  return range;
}

// A flat marker is visible up to 75 degrees off its normal and is then narrower: half of its disc
// is as likely as the complete disc.
constexpr double k_flat_visible_part_min = 0.4;

MarkerOptics marker_optics(const Cell& cell) {
  const Camera& camera = cell.camera;
  const RadiusRange radius = radii(cell.tools);
  MarkerOptics optics;
  optics.radius_min_m = radius.smallest_m;
  optics.radius_max_m = radius.largest_m;
  for (int t = 0; t < cell.tools.count; ++t) {
    if (cell.tools.items[static_cast<std::size_t>(t)].shape == MarkerShape::disc)
      optics.visible_part_min = k_flat_visible_part_min;
  }
  optics.focal_px = camera.model.fx;
  optics.range_min_m = camera.range_min_m;
  optics.range_max_m = camera.range_max_m;
  optics.depth_unit_m = camera.depth.unit_m;
  optics.depth_invalid_from = camera.depth.invalid_from;
  return optics;
}

BlobSettings blob_settings(const Cell& cell) {
  const Camera& camera = cell.camera;
  const RadiusRange radius = radii(cell.tools);
  const SizeGate small =
      size_gate(radius.smallest_m, camera.range_min_m, camera.range_max_m, camera.model.fx);
  const SizeGate large =
      size_gate(radius.largest_m, camera.range_min_m, camera.range_max_m, camera.model.fx);
  BlobSettings settings;
  settings.min_area_px = small.min_area_px;
  settings.max_area_px = large.max_area_px;
  settings.threshold = camera.threshold;
  settings.saturated_from = camera.depth.saturated_from;
  settings.noise = camera.noise;
  settings.sizes = marker_sizes(marker_optics(cell));
  return settings;
}

NominalMarker nominal_marker(const ToolSet& tools) {
  const RadiusRange radius = radii(tools);
  NominalMarker nominal;
  nominal.radius_m = 0.5 * (radius.smallest_m + radius.largest_m);
  if (tools.count > 0) nominal.shape = tools.items[0].shape;
  return nominal;
}

double square(double value) { return value * value; }

CorrespondSettings correspond_settings(const Cell& cell) {
  CorrespondSettings settings;
  // Keeps the default ratio of the limit to the declared standard deviation.
  settings.max_rms_m *= cell.camera.range_sigma_m / settings.range_sigma_m;
  settings.range_sigma_m = cell.camera.range_sigma_m;
  settings.pixel_sigma_px = cell.camera.pixel_sigma_px;
  settings.focal_px = cell.camera.model.fx;
  settings.range_min_m = cell.camera.range_min_m;
  settings.range_max_m = cell.camera.range_max_m;
  // A smaller labeling is useful only if another tool may hold the missing marker.
  settings.fewer_markers_max = cell.tools.count > 1 ? 1 : 0;
  return settings;
}

ReachSettings reach_settings(const Cell& cell) {
  ReachSettings settings;
  settings.lost_after = cell.lost_after;
  settings.motion = cell.motion;
  settings.head_correlation_s = cell.head_noise.motion_correlation_s;
  return settings;
}

TrackSettings track_settings(const Cell& cell) {
  TrackSettings settings;
  settings.lost_after = cell.lost_after;
  settings.velocity_gap_max = std::max(settings.velocity_gap_max, cell.camera.period * 3);
  return settings;
}

// Nodes that both trackers have: all from the candidate markers on.
template <class AnyTracker>
void configure_common(const Cell& cell, AnyTracker& tracker) {
  const Limits limits = limits_of(cell);
  tracker.template node<PredictTracks>().settings = reach_settings(cell);
  tracker.template node<PredictTracks>().camera = cell.camera.model;
  tracker.template node<PredictTracks>().limits = limits;
  tracker.template for_each<Correspond>([&](Correspond& node) {
    node.settings = correspond_settings(cell);
    node.limits = limits;
  });
  tracker.template node<AssignMarkers>().limits = limits;
  tracker.template node<NameFew>().limits = limits;
  const MarkerNoise noise = declared_noise(cell.camera);
  tracker.template node<NameFew>().noise = noise;
  tracker.template for_each<RefinePose>([&](RefinePose& node) {
    node.limits = limits;
    node.noise = noise;
    node.estimate_noise = cell.camera.estimate_noise;
    node.correction = cell.correction;
    node.uncertainty = cell.camera.uncertainty;
  });
  tracker.template node<AnchorHead>().limits = limits;
  tracker.template node<AnchorHead>().reference = cell.reference;
  tracker.template node<AnchorHead>().noise = cell.head_noise;
  tracker.template for_each<FollowMotion>([&](FollowMotion& node) {
    node.limits = limits;
    node.settings.motion = cell.motion;
    node.settings.rest.correlation = cell.camera.correlation;
  });
  tracker.template node<TrackTools>().settings = track_settings(cell);
  tracker.template node<TrackTools>().noise = noise;
  tracker.template node<TrackTools>().estimate_noise = cell.camera.estimate_noise;
  tracker.template node<TrackTools>().limits = limits;
}

template <class AnyGraph>
void prepare(AnyGraph& graph) {
  if (const graph::Prepared prepared = graph.prepare(); !prepared) {
    throw std::logic_error("node " + std::string(prepared.name) + " cannot be prepared: " +
                           std::string(name_of(static_cast<Reason>(prepared.reason))));
  }
}

}  // namespace

void configure(const Cell& cell, Tracker& tracker) {
  const Camera& camera = cell.camera;
  StampFrame& stamp = tracker.node<StampFrame>();
  stamp.width = camera.model.width;
  stamp.height = camera.model.height;
  stamp.reflectivity_bits = camera.reflectivity_bits;
  LocateRois& locate = tracker.node<LocateRois>();
  locate.camera = camera.model;
  locate.limits = limits_of(cell);
  tracker.for_each<RoiThreshold>([&](RoiThreshold& node) {
    node.threshold = camera.threshold;
    node.limits = locate.limits;
  });
  tracker.node<FindBlobs>().settings = blob_settings(cell);
  tracker.node<FindBlobs>().limits = locate.limits;
  BackProject& back_project = tracker.node<BackProject>();
  back_project.camera = camera.model;
  back_project.depth = camera.depth;
  back_project.nominal = nominal_marker(cell.tools);
  back_project.limits = locate.limits;
  configure_common(cell, tracker);
  prepare(tracker);
}

void configure(const Cell& cell, MarkerTracker& tracker) {
  configure_common(cell, tracker);
  prepare(tracker);
}

void configure(const Cell& cell, Output& output) {
  PredictTools& predict = output.node<PredictTools>();
  predict.settings.nominal_gap = cell.camera.period;
  predict.settings.lost_after = cell.lost_after;
  predict.settings.actuation_delay = cell.actuation_delay;
  predict.settings.motion = cell.motion;
  predict.settings.stamp_sigma_s = cell.camera.uncertainty.time_stamp_s;
  predict.settings.robot_covariance.diagonal() << Vector3::Constant(square(cell.robot_sigma_m)),
      Vector3::Constant(square(cell.robot_sigma_rad));
  predict.limits = limits_of(cell);
  PackCan& pack = output.node<PackCan>();
  pack.settings.format = cell.can.format;
  pack.settings.base_identifier = cell.can.base_id;
  pack.settings.node = static_cast<unsigned>(cell.can.node);
  pack.limits = predict.limits;
  prepare(output);
}

MarkerNoise declared_noise(const Camera& camera) noexcept {
  const CameraModel& model = camera.model;
  return {camera.range_sigma_m, camera.pixel_sigma_px, model.fx, {model.cx, model.cy}};
}

RobotFrame declared_robot_frame(const Cell& cell) {
  RobotFrame robot;
  if (!cell.robot_valid) return robot;
  robot.state = RegistrationState::given;
  robot.T_world_robot = cell.T_world_robot;
  robot.in_reference = cell.robot_in_reference;
  return robot;
}

}  // namespace glint
