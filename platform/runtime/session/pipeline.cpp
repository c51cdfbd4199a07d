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

}  // namespace

void set_up(const Cell& cell, StampFrame& node) {
  node.width = cell.camera.model.width;
  node.height = cell.camera.model.height;
  node.reflectivity_bits = cell.camera.reflectivity_bits;
}

void set_up(const Cell& cell, PredictTracks& node) {
  node.settings = reach_settings(cell);
  node.camera = cell.camera.model;
}

void set_up(const Cell& cell, LocateRois& node) { node.camera = cell.camera.model; }

void set_up(const Cell& cell, RoiThreshold& node) { node.threshold = cell.camera.threshold; }

void set_up(const Cell& cell, FindBlobs& node) { node.settings = blob_settings(cell); }

void set_up(const Cell& cell, BackProject& node) {
  node.camera = cell.camera.model;
  node.depth = cell.camera.depth;
  node.nominal = nominal_marker(cell.tools);
}

void set_up(const Cell& cell, Correspond& node) { node.settings = correspond_settings(cell); }

void set_up(const Cell& cell, NameFew& node) { node.noise = declared_noise(cell.camera); }

void set_up(const Cell& cell, RefinePose& node) {
  node.noise = declared_noise(cell.camera);
  node.estimate_noise = cell.camera.estimate_noise;
  node.correction = cell.correction;
  node.uncertainty = cell.camera.uncertainty;
}

void set_up(const Cell& cell, AnchorHead& node) {
  node.reference = cell.reference;
  node.noise = cell.head_noise;
}

void set_up(const Cell& cell, FollowMotion& node) {
  node.settings.motion = cell.motion;
  node.settings.rest.correlation = cell.camera.correlation;
}

void set_up(const Cell& cell, TrackTools& node) {
  node.settings = track_settings(cell);
  node.noise = declared_noise(cell.camera);
  node.estimate_noise = cell.camera.estimate_noise;
}

void set_up(const Cell& cell, PredictTools& node) {
  node.settings.nominal_gap = cell.camera.period;
  node.settings.lost_after = cell.lost_after;
  node.settings.actuation_delay = cell.actuation_delay;
  node.settings.motion = cell.motion;
  node.settings.stamp_sigma_s = cell.camera.uncertainty.time_stamp_s;
  node.settings.robot_covariance.diagonal() << Vector3::Constant(square(cell.robot_sigma_m)),
      Vector3::Constant(square(cell.robot_sigma_rad));
}

void set_up(const Cell& cell, PackCan& node) {
  node.settings.format = cell.can.format;
  node.settings.base_identifier = cell.can.base_id;
  node.settings.node = static_cast<unsigned>(cell.can.node);
}

void require_prepared(const graph::Prepared& prepared) {
  if (prepared) return;
  throw std::logic_error("node " + std::string(prepared.name) + " cannot be prepared: " +
                         std::string(name_of(static_cast<Reason>(prepared.reason))));
}

void configure(const Cell& cell, Tracker& tracker) { configure<Tracker>(cell, tracker); }
void configure(const Cell& cell, MarkerTracker& tracker) {
  configure<MarkerTracker>(cell, tracker);
}
void configure(const Cell& cell, Output& output) { configure<Output>(cell, output); }

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
