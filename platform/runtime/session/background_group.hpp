// Background group of a run: one bounded slice of mapping and of robot following per period, at a
// priority below frames and ticks.
//
// Live, it runs at the lowest priority of the schedule, or at SCHED_IDLE if real-time rights are
// refused, so that no tick and no frame waits for it. In order, its slices run at their nominal
// times.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "graph/latest.hpp"
#include "kernels/cloud/leave_out_capsules.hpp"
#include "nodes/mapper.hpp"
#include "nodes/tokens.hpp"
#include "platform/cells/cell.hpp"
#include "platform/runtime/rt/followed_robot.hpp"
#include "platform/runtime/rt/real_time_thread.hpp"
#include "platform/runtime/session/depth_loop.hpp"
#include "platform/runtime/session/group_runner.hpp"
#include "platform/runtime/session/robot_link_poses.hpp"
#include "platform/runtime/session/run_schedule.hpp"
#include "platform/sinks/dds/dds_sink.hpp"
#include "platform/sinks/record/recorder.hpp"
#include "platform/tools/robot/robot_cloud.hpp"

namespace glint {

extern template class GroupRunner<Background>;  // in background_group.cpp, once

// Inputs of a background group, read from the files that its cell names.
struct BackgroundScene {
  DepthLoop images;
  RobotCloud model;
  LinkPoses poses;  // of the model's links, at the cell's joints
};

// Returns an empty scene if the cell has no [mapping]. Throws InputError with the name of the file
// that is missing or wrong; with `png` null, every PNG file is wrong.
[[nodiscard]] BackgroundScene read_background_scene(const Cell& cell, DepthPngReader png);

// Capsule about the line from a tool's tip to its markers' centre, extended over the hand behind
// it.
inline constexpr double k_tool_capsule_radius_m = 0.08, k_tool_capsule_extension_m = 0.15;

// Capsules of the tracked tools and of the hands that hold them; the map excludes them.
struct TrackedCapsules {
  std::array<ExclusionCapsule, k_tools_max> items;  // in the world
  int count = 0;
  [[nodiscard]] std::span<const ExclusionCapsule> all() const {
    return std::span(items).first(static_cast<std::size_t>(count));
  }
};

// Capsules of the tools that are tracked in the world frame.
[[nodiscard]] TrackedCapsules capsules_of(const Estimates& estimates);

struct BackgroundCounts {
  std::uint64_t slices = 0;
  std::uint64_t late = 0;          // slices that ended after the next one was due
  std::uint64_t skipped = 0;       // releases during a slice that still ran
  Duration longest_response;       // from nominal release to the slice's end; in order: zero
  int longest_steps = 0;           // maximum over the slices
  std::int64_t images_missed = 0;  // taken while another one was processed; not used
  MapTotals map;
  RobotProgress robot;
  std::int64_t joints_used = 0, joints_skipped = 0;  // of the received joint states
  std::int64_t images_without_joints = 0;            // without robot search: joints too old
};

// Outputs of the followed robot's pose, written before every tick that reads it; each may be null.
struct RobotSinks {
  graph::TripleBuffer<RobotFrame>* published = nullptr;  // version 1: the cell's own
  RecorderLane* lane = nullptr;
  RobotTrackingStatus* notes = nullptr;
  DdsSink* dds = nullptr;
};

// Map settings of a cell with [mapping]; candidate limits are reduced to those of a slice.
[[nodiscard]] MapSettings map_settings_of(const Cell& cell);

class BackgroundGroup {
 public:
  // Requires a cell with a background. `trace` may be null and must not be started yet. Allocates
  // all memory here. Throws InputError for map sizes that no map can have.
  BackgroundGroup(const Cell& cell, const GroupSchedule<Background>& plan, TraceWriter* trace,
                  BackgroundScene scene, RobotSinks sinks = {});

  // Sets the source of the robot's joints; call before the first slice. The slice that begins an
  // image reads the newest joints.
  void set_joint_source(graph::TripleBuffer<ReceivedJoints>& joints) noexcept {
    joint_source_ = &joints;
  }

  // Settings for the thread that calls run().
  [[nodiscard]] static ThreadSettings thread_settings(const GroupSchedule<Background>& plan);

  // Runs from `epoch` until `stop` is set; returns at most a slice and some milliseconds after it.
  void run(Time epoch, const std::atomic<bool>& stop) noexcept;
  // For runs that are not in real time: runs all slices due by `now`.
  void run_due_slices(Time now) noexcept;

  // Written by the frame group; the map excludes these capsules.
  [[nodiscard]] graph::TripleBuffer<TrackedCapsules>& tracked() noexcept { return tracked_; }

  // Number of images whose robot pose was rejected as a jump. Thread-safe.
  [[nodiscard]] std::int64_t jumps() const noexcept { return jumps_; }
  // Number of images not searched for the robot because its joints were too old. Thread-safe.
  [[nodiscard]] std::int64_t without_joints() const noexcept { return without_joints_; }
  // First joint of the model that a received state lacked; null: none. Thread-safe.
  [[nodiscard]] const std::string* missing_joint() const noexcept { return robot_.missing_joint(); }
  // Why the first complete state could not pose the model; Reason::none: all could. Thread-safe.
  [[nodiscard]] Reason unusable_joints() const noexcept { return robot_.unusable(); }

  // Call after run() has returned: computes a last map of all completed images.
  void finish() noexcept;
  [[nodiscard]] const BackgroundCounts& counts() const noexcept { return counts_; }
  [[nodiscard]] const PointCloud& map() noexcept { return graph_.node<ExtendMap>().map().map(); }

 private:
  void slice(Time nominal, Time now) noexcept;
  void set_image(std::int64_t number) noexcept;
  [[nodiscard]] bool is_idle() const noexcept;
  void publish_robot(const RobotProgress& robot) noexcept;
  void update_robot_notes(const RobotProgress& robot) const noexcept;
  [[nodiscard]] bool joints_valid_at(Time time) noexcept;

  Background graph_;
  std::vector<std::byte> memory_;
  GroupRunner<Background> runner_;
  Duration period_;
  BackgroundScene scene_;
  RobotLinkPoses robot_;
  graph::TripleBuffer<ReceivedJoints>* joint_source_ = nullptr;
  RobotSinks sinks_;
  std::uint64_t robot_version_ = 1;
  std::atomic<std::int64_t> jumps_{0}, without_joints_{0};
  std::int64_t last_image_ = 0;
  std::int64_t next_ = 0;  // number of the next slice, in order
  graph::TripleBuffer<TrackedCapsules> tracked_;
  std::array<ExclusionCapsule, k_exclusion_capsules_max> left_out_;
  BackgroundCounts counts_;
};

}  // namespace glint
