// Where the robot stands, followed by one slice of work at each activation: slow drift of the
// headset's world is followed, a jump is refused and told. A picture in which its links were
// elsewhere than before poses its model first, in slices as well.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

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
  LinkCloud model;          // none: nothing is followed
  ShownDepth::Links links;  // that prepare() poses it by
  Pose T_world_robot;
  Matrix6 covariance = Matrix6::Zero();  // of T_world_robot, as ReferenceFollower has it
  int pixels_max = 0;                    // of a picture's shown part
  Limits limits;

  [[nodiscard]] Reason prepare() {
    const std::size_t count = model.cloud.points.size();
    if (count == 0) return Reason::none;
    if (links.poses == nullptr) return Reason::not_prepared;
    points_.resize(count);
    normals_.resize(count);
    Reason reason = pose_cloud(model, *links.poses, points_, normals_);
    if (reason != Reason::none) return reason;
    posed_by_ = links.number;
    follower_.settings = settings;
    reason = follower_.prepare(pixels_max, static_cast<int>(count));
    // A picture at the clock's zero is newer than what is given.
    if (reason == Reason::none) follower_.begin(T_world_robot, covariance, Time{-1});
    return reason;
  }
  void operator()(const ShownDepth& shown, RobotProgress& progress) noexcept {
    if (shown.number != looked_at_) take_up(shown);
    steps_ = 0;
    if (posing_) pose();
    if (!posing_ && steps_ < limits.reference_steps) follow();
    known_.free = !posing_ && follower_.idle();
    known_.steps = steps_;
    progress = known_;
  }

  // A step is about a distance between two points: kernels/slice_size.hpp. The last item may be a
  // point that is posed, or one of the follower's, which are larger.
  static_assert(k_posed_item_steps_max <= k_follow_item_steps_max);
  static constexpr std::array<std::string_view, 2> k_loops = {"call", "steps"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    const int steps = limits.reference_steps;
    return {{1, steps > 0 ? steps + k_follow_item_steps_max : 0}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return {{1, steps_}}; }

 private:
  void take_up(const ShownDepth& shown) noexcept {
    looked_at_ = shown.number;
    const bool follows = !model.cloud.points.empty() && limits.reference_steps > 0;
    const bool posed = shown.links.number == posed_by_;
    const bool poses = shown.links.poses != nullptr;
    if (!follows || shown.scene.depth_m.empty() || !(posed || poses)) return;
    view_.camera = shown.scene.camera;
    view_.depth_m = shown.scene.depth_m;
    view_.T_camera_world = shown.picture.T_world_camera.inverse();
    view_.cloud = {points_, normals_, model.cloud.spacing_m};
    time_ = shown.time;
    posing_ = !posed;
    if (posed) {
      (void)follower_.look(view_, time_);
      return;
    }
    posed_by_.reset();
    posing_by_ = shown.links.number;
    (void)run_.start(model, *shown.links.poses, points_, normals_);  // it fitted in prepare()
  }
  void pose() noexcept {
    StepBudget budget(limits.reference_steps);
    posing_ = run_.step(budget);
    steps_ = limits.reference_steps - budget.left();
    if (posing_) return;
    if (run_.reason() != Reason::none) {  // a link without a pose: nothing can be told
      ++known_.unsure;
      return;
    }
    posed_by_ = posing_by_;
    (void)follower_.look(view_, time_);
  }
  void follow() noexcept {
    const bool under_way = !follower_.idle();
    steps_ += follower_.step(limits.reference_steps - steps_);
    if (under_way && follower_.idle()) note();
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

  std::vector<Vector3f> points_, normals_;  // the model's, in the robot's base
  std::optional<std::uint64_t> posed_by_;   // the poses' number; none: they are posed in part
  PoseCloudRun run_;
  std::uint64_t posing_by_ = 0;
  bool posing_ = false;
  ReferenceFollower follower_;
  SceneView view_;
  RobotProgress known_;
  Time time_;
  std::uint64_t looked_at_ = 0;
  int steps_ = 0;
};
static_assert(graph::Budgeted<FollowRobot, Limits>);

}  // namespace glint
