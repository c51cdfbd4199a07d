#include "platform/runtime/session/background_group.hpp"

#include <algorithm>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/runtime/rt/clock.hpp"
#include "platform/runtime/session/release_records.hpp"

namespace glint {

template class GroupRunner<Background>;
namespace {

// Longest time until run() notices the end of the session.
constexpr Duration k_stop_poll_period = milliseconds(20);

// Prior variance of the robot's pose in the cell: 10 mm and a degree, squared.
constexpr double k_prior_variance_m2 = 1e-4, k_prior_variance_rad2 = 3e-4;

RunnerSettings<Background> background_settings(const Cell& cell,
                                               const GroupSchedule<Background>& plan,
                                               TraceWriter* trace) {
  RunnerSettings<Background> settings;
  settings.plan = plan.tables;
  settings.group = k_background_group;
  settings.bounds_ns = plan.bounds_ns;
  settings.live = cell.realtime;
  settings.trace = trace;
  return settings;
}

// Returns true at `due`; false if the session ends first or the system refuses to sleep.
bool wait_until(Time due, const std::atomic<bool>& stop) noexcept {
  while (!stop) {
    const Time now = monotonic_now();
    if (now >= due) return true;
    if (!sleep_until(std::min(due, now + k_stop_poll_period))) return false;
  }
  return false;
}

}  // namespace

BackgroundScene read_background_scene(const Cell& cell, DepthPngReader png) {
  BackgroundScene scene;
  if (!cell.mapping) return scene;
  const MappingSettings& mapping = *cell.mapping;
  scene.images = {read_depth_sequence(mapping.source, png), mapping.period};
  if (mapping.model.empty()) return scene;
  scene.model = read_robot_cloud(mapping.model);
  scene.poses = link_poses(scene.model, mapping.joints, cell.file + ": mapping.joints");
  return scene;
}

TrackedCapsules capsules_of(const Estimates& estimates) {
  TrackedCapsules out;
  for (int t = 0; t < estimates.tool_count; ++t) {
    const auto at = static_cast<std::size_t>(t);
    const Track& track = estimates.tracks[at];
    if (!track.alive || track.base != ReferenceFrame::world) continue;
    const Pose& T_world_middle = track.motion.pose;
    const Vector3 arm = T_world_middle.rotation * estimates.tips[at].arm_m;
    const double length = arm.norm();
    const Vector3 back =
        length > 0 ? Vector3(arm * (-k_tool_capsule_extension_m / length)) : Vector3::Zero();
    const Vector3& middle = T_world_middle.translation;
    out.items[static_cast<std::size_t>(out.count++)] = {middle + arm, middle + back,
                                                        k_tool_capsule_radius_m};
  }
  return out;
}

MapSettings map_settings_of(const Cell& cell) {
  MapSettings settings;
  settings.depth.stride = cell.mapping->stride;
  settings.voxels.voxel_m = static_cast<float>(cell.mapping->voxel_m);
  settings.voxels_max = cell.mapping->voxels_max;
  return limited_for_slices(settings);
}

BackgroundGroup::BackgroundGroup(const Cell& cell, const GroupSchedule<Background>& plan,
                                 TraceWriter* trace, BackgroundScene scene, RobotSinks sinks)
    : runner_(background_settings(cell, plan, trace)),
      period_(cell.background->period),
      scene_(std::move(scene)),
      robot_(scene_.model, scene_.poses,
             cell.mapping ? cell.mapping->joints_lost_after : Duration{}),
      sinks_(sinks) {
  ExtendMap& map = graph_.node<ExtendMap>();
  map.limits = limits_of(cell);
  if (cell.mapping) {
    map.settings = map_settings_of(cell);
    map.images_per_map = cell.mapping->images_per_map;
    memory_.resize(MapSlices::bytes(map.settings));
    map.memory = memory_;
  }
  FollowRobot& robot = graph_.node<FollowRobot>();
  robot.limits = map.limits;
  robot.model = scene_.model.cloud();
  robot.links = robot_.links();
  robot.T_world_robot = cell.T_world_robot;
  robot.covariance.diagonal() << k_prior_variance_m2, k_prior_variance_m2, k_prior_variance_m2,
      k_prior_variance_rad2, k_prior_variance_rad2, k_prior_variance_rad2;
  robot.pixels_max = k_scene_pixels_max;
  if (const graph::Prepared ready = graph_.prepare(); !ready) {
    throw InputError(cell.file +
                     ": mapping: " + std::string(name_of(static_cast<Reason>(ready.reason))) +
                     "; expected valid map sizes");
  }
}

ThreadSettings BackgroundGroup::thread_settings(const GroupSchedule<Background>& plan) {
  ThreadSettings settings{"glint-slices", plan.cores[0], plan.priority};
  settings.idle_if_refused = true;
  return settings;
}

void BackgroundGroup::run(Time epoch, const std::atomic<bool>& stop) noexcept {
  for (std::int64_t number = 0; wait_until(epoch + period_ * number, stop);) {
    const Time nominal = Time{} + period_ * number;
    slice(nominal, Time{} + (monotonic_now() - epoch));
    const Duration ended = monotonic_now() - epoch;
    const Duration response = Time{} + ended - nominal;
    if (response > period_) ++counts_.late;
    counts_.longest_response = std::max(counts_.longest_response, response);
    const std::int64_t next = ended.nanoseconds / period_.nanoseconds + 1;
    counts_.skipped += static_cast<std::uint64_t>(next - number - 1);
    number = next;
  }
}

void BackgroundGroup::run_due_slices(Time now) noexcept {
  for (; Time{} + period_ * next_ <= now; ++next_) {
    const Time nominal = Time{} + period_ * next_;
    slice(nominal, nominal);
  }
}

void BackgroundGroup::slice(Time nominal, Time now) noexcept {
  if (is_idle()) set_image(scene_.images.newest(nominal));
  const std::uint64_t activation = ++counts_.slices;
  (void)runner_.run(graph_, {activation, activation, nominal, now, 0});
  runner_.finish_activation(graph_);
  const MapProgress& progress = std::as_const(graph_).output<MapProgress>();
  const RobotProgress& robot = std::as_const(graph_).output<RobotProgress>();
  counts_.longest_steps = std::max({counts_.longest_steps, progress.steps, robot.steps});
  counts_.map = progress.totals;
  if (robot.followed > counts_.robot.followed) publish_robot(robot);
  jumps_ = robot.jumps;
  if (sinks_.notes != nullptr) update_robot_notes(robot);
  counts_.robot = robot;
}

bool BackgroundGroup::is_idle() const noexcept {
  return graph_.output<MapProgress>().free && graph_.output<RobotProgress>().free;
}

// Records the frame before publishing it, so that its record precedes those of the ticks that read
// it.
void BackgroundGroup::publish_robot(const RobotProgress& robot) noexcept {
  ++robot_version_;
  const RobotFrame& frame = robot.frame;
  if (sinks_.lane != nullptr) {
    (void)sinks_.lane->offer_robot_frame({robot_version_, robot.time, frame.state,
                                          frame.T_world_robot, frame.rms_m, frame.in_reference});
  }
  if (sinks_.dds != nullptr) sinks_.dds->offer_robot(frame.T_world_robot);
  if (sinks_.published == nullptr) return;
  sinks_.published->write_slot() = frame;
  sinks_.published->publish(robot_version_, robot.time.nanoseconds);
}

// An image without a usable result leaves `jumped` unchanged.
void BackgroundGroup::update_robot_notes(const RobotProgress& robot) const noexcept {
  RobotTrackingStatus& notes = *sinks_.notes;
  notes.translation_m.store(robot.translation_m, std::memory_order_relaxed);
  notes.rotation_rad.store(robot.rotation_rad, std::memory_order_relaxed);
  notes.jumps.store(robot.jumps, std::memory_order_relaxed);
  notes.inconclusive.store(robot.inconclusive, std::memory_order_relaxed);
  if (robot.jumps > counts_.robot.jumps) notes.jumped.store(true, std::memory_order_relaxed);
  if (robot.followed > counts_.robot.followed) notes.jumped.store(false, std::memory_order_relaxed);
  notes.followed.store(robot.followed, std::memory_order_relaxed);
}

// Returns false if the joint positions are too old: then the robot's posture is unknown and it is
// not searched for.
bool BackgroundGroup::joints_valid_at(Time time) noexcept {
  if (joint_source_ == nullptr) return true;
  robot_.update(*joint_source_);
  counts_.joints_used = robot_.used();
  counts_.joints_skipped = robot_.skipped();
  const bool known = robot_.is_valid_at(time);
  if (!known) without_joints_ = ++counts_.images_without_joints;
  if (sinks_.notes != nullptr) {
    sinks_.notes->skipped_without_joints.store(counts_.images_without_joints,
                                               std::memory_order_relaxed);
    sinks_.notes->joints_lost.store(!known, std::memory_order_relaxed);
  }
  return known;
}

void BackgroundGroup::set_image(std::int64_t number) noexcept {
  if (number <= last_image_) return;
  counts_.images_missed += number - last_image_ - 1;
  last_image_ = number;
  const DepthLoop& images = scene_.images;
  const Time taken = images.time_of(number);
  const DepthFrame& frame = images.image(number);
  (void)tracked_.sample();
  const auto end = std::copy_n(
      frame.left_out.begin(), std::min(frame.left_out.size(), left_out_.size()), left_out_.begin());
  const std::span<const ExclusionCapsule> held = tracked_.value().all();
  const auto room = static_cast<std::size_t>(left_out_.end() - end);
  const auto all = std::copy_n(held.begin(), std::min(held.size(), room), end);
  const auto count = static_cast<std::size_t>(all - left_out_.begin());
  const bool known = joints_valid_at(taken);
  graph_.input<ShownDepth>() = {
      {frame.picture(), images.camera(), frame.T_world_camera, std::span(left_out_).first(count)},
      known ? images.scene(number) : ShownDepth::Scene{},
      robot_.links(),
      taken,
      static_cast<std::uint64_t>(number)};
}

void BackgroundGroup::finish() noexcept {
  ExtendMap& node = graph_.node<ExtendMap>();
  const auto run_on = [&] {
    while (!is_idle()) graph_.activate();
  };
  run_on();
  node.start_map();
  graph_.activate();
  run_on();
  counts_.map = std::as_const(graph_).output<MapProgress>().totals;
}

}  // namespace glint
