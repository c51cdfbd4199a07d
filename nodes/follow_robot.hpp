// Where the robot stands, followed by one slice of work at each activation: slow drift of the
// headset's world is followed, a jump is refused and told.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "graph/loops.hpp"
#include "kernels/limits.hpp"
#include "kernels/registration/follow_reference.hpp"
#include "nodes/extend_map.hpp"
#include "nodes/tokens.hpp"

namespace glint {

struct RobotProgress {
  bool free = true;  // nothing is borrowed
  int steps = 0;     // of this slice
  // Of the pictures so far: followed, refused as jumps, and with too little to tell by.
  std::int64_t followed = 0, jumps = 0, unsure = 0;
  FollowOutcome last = FollowOutcome::no_reference;
  double shift_m = 0, turn_rad = 0;  // of the last jump
  Time time;                         // of the last picture that was followed
  RobotFrame frame;                  // where it is taken to be, once it was followed
};

struct FollowRobot {
  FollowSettings settings;
  ModelCloud model;  // in the robot's base, at its joints' positions; none: nothing is followed
  Pose T_world_robot;
  Matrix6 covariance = Matrix6::Zero();  // of T_world_robot, as ReferenceFollower has it
  int pixels_max = 0;                    // of a picture's shown part
  Limits limits;

  [[nodiscard]] Reason prepare() {
    if (model.points.empty()) return Reason::none;
    follower_.settings = settings;
    const Reason reason = follower_.prepare(pixels_max, static_cast<int>(model.points.size()));
    // A picture at the clock's zero is newer than what is given.
    if (reason == Reason::none) follower_.begin(T_world_robot, covariance, Time{-1});
    return reason;
  }
  void operator()(const ShownDepth& shown, RobotProgress& progress) noexcept {
    if (shown.number != looked_at_) look(shown);
    const bool under_way = !follower_.idle();
    steps_ = follower_.step(limits.reference_steps);
    if (under_way && follower_.idle()) note();
    known_.free = follower_.idle();
    known_.steps = steps_;
    progress = known_;
  }

  // A step is about a distance between two points: kernels/slice_size.hpp.
  static constexpr std::array<std::string_view, 2> k_loops = {"call", "steps"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    const int steps = limits.reference_steps;
    return {{1, steps > 0 ? steps + k_follow_item_steps_max : 0}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return {{1, steps_}}; }

 private:
  void look(const ShownDepth& shown) noexcept {
    looked_at_ = shown.number;
    if (model.points.empty() || shown.scene.depth_m.empty() || limits.reference_steps < 1) return;
    SceneView view;
    view.camera = shown.scene.camera;
    view.depth_m = shown.scene.depth_m;
    view.T_camera_world = shown.picture.T_world_camera.inverse();
    view.cloud = model;
    time_ = shown.time;
    (void)follower_.look(view, shown.time);
  }
  void note() noexcept {
    const FollowReport& report = follower_.report();
    known_.last = report.outcome;
    if (report.outcome == FollowOutcome::jumped) {
      ++known_.jumps;
      known_.shift_m = report.shift_m;
      known_.turn_rad = report.turn_rad;
    }
    if (report.outcome != FollowOutcome::followed) {
      known_.unsure += report.outcome == FollowOutcome::jumped ? 0 : 1;
      return;
    }
    ++known_.followed;
    known_.time = time_;
    known_.frame.state = RegistrationState::accepted;
    known_.frame.T_world_robot = follower_.reference(time_).T_world_base;
    known_.frame.rms_m = report.seen.residual_m;
  }

  ReferenceFollower follower_;
  RobotProgress known_;
  Time time_;
  std::uint64_t looked_at_ = 0;
  int steps_ = 0;
};
static_assert(graph::Budgeted<FollowRobot, Limits>);

}  // namespace glint
