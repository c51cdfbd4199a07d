// Robot pose tracking in depth images, one slice of bounded work per activation. Follows slow drift
// of the headset's world; rejects and reports jumps. If an image comes with new link poses, the
// robot model is posed first, also in slices.
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
  // Numbers of images so far: pose followed, rejected as a jump, inconclusive.
  std::int64_t followed = 0, jumps = 0, inconclusive = 0;
  FollowOutcome last = FollowOutcome::no_reference;
  double translation_m = 0, rotation_rad = 0;  // of the last jump
  Time time;                                   // of the last image whose pose was followed
  RobotFrame frame;                            // the current robot pose, once an image was followed
};

struct FollowRobot {
  FollowSettings settings;
  LinkCloud model;          // empty: no robot is tracked
  ShownDepth::Links links;  // link poses used by prepare()
  Pose T_world_robot;
  Matrix6 covariance = Matrix6::Zero();  // of T_world_robot, as in RobotPoseTracker
  int pixels_max = 0;                    // of the scene part of an image
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
    // Time -1: an image at time 0 is then newer than the initial pose.
    if (reason == Reason::none) follower_.begin(T_world_robot, covariance, Time{-1});
    return reason;
  }
  void operator()(const ShownDepth& input, RobotProgress& progress) noexcept {
    if (input.number != last_number_) start_image(input);
    steps_ = 0;
    if (posing_) pose();
    if (!posing_ && steps_ < limits.tracking_steps) follow();
    progress_.free = !posing_ && follower_.idle();
    progress_.steps = steps_;
    progress = progress_;
  }

  // One step is about one point-to-point distance: kernels/slice_size.hpp. The last item of a slice
  // is a posed model point or an item of the follower, which is larger.
  static_assert(k_posed_item_steps_max <= k_follow_item_steps_max);
  static constexpr std::array<std::string_view, 2> k_loops = {"call", "steps"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    const int steps = limits.tracking_steps;
    return {{1, steps > 0 ? steps + k_follow_item_steps_max : 0}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return {{1, steps_}}; }

 private:
  void start_image(const ShownDepth& input) noexcept {
    last_number_ = input.number;
    const bool follows = !model.cloud.points.empty() && limits.tracking_steps > 0;
    const bool posed = input.links.number == posed_by_;
    const bool poses = input.links.poses != nullptr;
    if (!follows || input.scene.depth_m.empty() || !(posed || poses)) return;
    view_.camera = input.scene.camera;
    view_.depth_m = input.scene.depth_m;
    view_.T_camera_world = input.image.T_world_camera.inverse();
    view_.cloud = {points_, normals_, model.cloud.spacing_m};
    time_ = input.time;
    posing_ = !posed;
    if (posed) {
      (void)follower_.look(view_, time_);
      return;
    }
    posed_by_.reset();
    posing_by_ = input.links.number;
    (void)run_.start(model, *input.links.poses, points_, normals_);  // fits: see prepare()
  }
  void pose() noexcept {
    StepBudget budget(limits.tracking_steps);
    posing_ = run_.step(budget);
    steps_ = limits.tracking_steps - budget.left();
    if (posing_) return;
    if (run_.reason() != Reason::none) {  // a link has no pose: inconclusive
      ++progress_.inconclusive;
      return;
    }
    posed_by_ = posing_by_;
    (void)follower_.look(view_, time_);
  }
  void follow() noexcept {
    const bool was_active = !follower_.idle();
    steps_ += follower_.step(limits.tracking_steps - steps_);
    if (was_active && follower_.idle()) store_outcome();
  }
  void store_outcome() noexcept {
    const FollowReport& report = follower_.report();
    progress_.last = report.outcome;
    if (report.outcome == FollowOutcome::jumped) {
      ++progress_.jumps;
      progress_.translation_m = report.shift_m;
      progress_.rotation_rad = report.turn_rad;
    }
    if (report.outcome != FollowOutcome::followed) {
      progress_.inconclusive += report.outcome == FollowOutcome::jumped ? 0 : 1;
      return;
    }
    ++progress_.followed;
    progress_.time = time_;
    progress_.frame.state = RegistrationState::accepted;
    progress_.frame.T_world_robot = follower_.reference(time_).T_world_base;
    progress_.frame.rms_m = report.seen.residual_m;
  }

  std::vector<Vector3f> points_, normals_;  // the model's, in the robot's base
  std::optional<std::uint64_t> posed_by_;   // number of the link poses; none: posed only in part
  PoseCloudRun run_;
  std::uint64_t posing_by_ = 0;
  bool posing_ = false;
  RobotPoseTracker follower_;
  SceneView view_;
  RobotProgress progress_;
  Time time_;
  std::uint64_t last_number_ = 0;
  int steps_ = 0;
};
static_assert(graph::Budgeted<FollowRobot, Limits>);

}  // namespace glint
