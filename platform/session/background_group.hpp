// The background group of a run: a slice of mapping and of following the robot at every period,
// beneath frames and ticks.
//
// Live it runs at the lowest priority of the plan, or where real-time rights are refused at the
// system's idle priority, so that no tick and no frame waits for it. In order its slices run at
// their nominal times.
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
#include "platform/dds/dds_sink.hpp"
#include "platform/record/recorder.hpp"
#include "platform/robot/robot_cloud.hpp"
#include "platform/rt/followed_robot.hpp"
#include "platform/rt/real_time_thread.hpp"
#include "platform/session/depth_loop.hpp"
#include "platform/session/group_runner.hpp"
#include "platform/session/heard_robot.hpp"
#include "platform/session/run_plan.hpp"

namespace glint {

extern template class GroupRunner<Background>;  // in background_group.cpp, once

// What a background looks at and for, read from the files that its cell names.
struct BackgroundScene {
  DepthLoop pictures;
  RobotCloud model;
  LinkPoses poses;  // of the model's links, at the cell's joints
};

// Empty where the cell has no [mapping]. Throws InputError naming the file that is missing or
// wrong; with `png` null a PNG is.
[[nodiscard]] BackgroundScene read_background_scene(const Cell& cell, DepthPngReader png);

// About a tool's line from its tip through its markers' middle, and the hand behind them.
inline constexpr double k_held_radius_m = 0.08, k_held_behind_m = 0.15;

// Where the tracked tools and the hands that hold them are: they stay out of the map.
struct TrackedCapsules {
  std::array<LeftOut, k_tools_max> items;  // in the world
  int count = 0;
  [[nodiscard]] std::span<const LeftOut> all() const {
    return std::span(items).first(static_cast<std::size_t>(count));
  }
};

// Of the tools that are tracked in the world.
[[nodiscard]] TrackedCapsules capsules_of(const Estimates& estimates);

struct BackgroundCounts {
  std::uint64_t slices = 0;
  std::uint64_t late = 0;            // of them: ended after the next one was due
  std::uint64_t skipped = 0;         // releases that came while a slice still ran
  Duration longest_response;         // from a nominal release to its slice's end; in order: none
  int longest_steps = 0;             // of a slice
  std::int64_t pictures_missed = 0;  // taken while another was looked at, and not shown
  MapTotals map;
  RobotProgress robot;
  std::int64_t joints_used = 0, joints_passed_over = 0;  // of the states that were heard
  std::int64_t pictures_without_joints = 0;  // not followed: the joints heard last were too old
};

// Where a robot that is followed is told, in front of every tick that reads it; each may be null.
struct RobotSinks {
  graph::TripleBuffer<RobotFrame>* published = nullptr;  // holds version 1: the cell's own
  RecorderLane* lane = nullptr;
  FollowedRobotNotes* notes = nullptr;
  DdsSink* dds = nullptr;
};

// What the cell's map is made by. Throws InputError where it would refuse a slice's bound.
[[nodiscard]] MapSettings map_settings_of(const Cell& cell);

class BackgroundGroup {
 public:
  // The cell has a background. `trace` may be null; it is not yet started. Takes all its memory.
  BackgroundGroup(const Cell& cell, const GroupPlan<Background>& plan, TraceWriter* trace,
                  BackgroundScene scene, RobotSinks sinks = {});

  // The robot's joints from now on; before the first slice. The newest are taken up by the slice
  // that begins a picture.
  void hear(graph::TripleBuffer<HeardJoints>& joints) noexcept { heard_ = &joints; }

  // The thread that run() wants to be called in.
  [[nodiscard]] static ThreadSettings thread_settings(const GroupPlan<Background>& plan);

  // From `epoch` on, until `stop`; returns at most a slice and some milliseconds after it.
  void run(Time epoch, const std::atomic<bool>& stop) noexcept;
  // In a run that keeps no real time: all slices that are due by then.
  void reach(Time now) noexcept;

  // The frame group's: what is tracked stays out of the map.
  [[nodiscard]] graph::TripleBuffer<TrackedCapsules>& tracked() noexcept { return tracked_; }

  // Pictures so far that show the robot where no drift takes it; any thread may ask.
  [[nodiscard]] std::int64_t jumps() const noexcept { return jumps_; }
  // Pictures so far that were not followed, because the joints heard last were too old; likewise.
  [[nodiscard]] std::int64_t without_joints() const noexcept { return without_joints_; }
  // The joint that the first state without all of the model's lacked, null: none did; likewise.
  [[nodiscard]] const std::string* lacking_joint() const noexcept { return robot_.lacking(); }
  // Why the first state with all of them could not pose the model; Reason::none: all could.
  [[nodiscard]] Reason unusable_joints() const noexcept { return robot_.unusable(); }

  // When run() has returned: a last map of all pictures that were shown whole.
  void finish() noexcept;
  [[nodiscard]] const BackgroundCounts& counts() const noexcept { return counts_; }
  [[nodiscard]] const PointCloud& map() noexcept { return graph_.node<ExtendMap>().map().map(); }

 private:
  void slice(Time nominal, Time now) noexcept;
  void show(std::int64_t number) noexcept;
  [[nodiscard]] bool is_free() const noexcept;
  void tell_robot(const RobotProgress& robot) noexcept;
  void note_robot(const RobotProgress& robot) const noexcept;
  [[nodiscard]] bool knows_joints_at(Time time) noexcept;

  Background graph_;
  std::vector<std::byte> memory_;
  GroupRunner<Background> runner_;
  Duration period_;
  BackgroundScene scene_;
  HeardRobot robot_;
  graph::TripleBuffer<HeardJoints>* heard_ = nullptr;
  RobotSinks sinks_;
  std::uint64_t robot_version_ = 1;
  std::atomic<std::int64_t> jumps_{0}, without_joints_{0};
  std::int64_t shown_ = 0;
  std::int64_t next_ = 0;  // slice in order
  graph::TripleBuffer<TrackedCapsules> tracked_;
  std::array<LeftOut, k_left_out_max> left_out_;
  BackgroundCounts counts_;
};

}  // namespace glint
