// Link poses of the followed robot, by forward kinematics from the received joint positions.
//
// Uses the newest joint state that has a position of each of the model's joints, whatever else it
// contains. Counts and skips a state without one of them. Until the first usable state, the links
// have their given poses. After it, the poses are valid for a limited time after the state's
// arrival. That time is measured by this machine's clock, since a time stamp is of another
// machine's.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "graph/latest.hpp"
#include "kernels/robot/forward_kinematics.hpp"
#include "kernels/units.hpp"
#include "nodes/extend_map.hpp"
#include "platform/sinks/dds/received_messages.hpp"
#include "platform/tools/robot/robot_cloud.hpp"

namespace glint {

class RobotLinkPoses {
 public:
  RobotLinkPoses() = default;
  // `given`: poses of the model's links until joints are received.
  RobotLinkPoses(const RobotCloud& model, const LinkPoses& given, Duration lost_after)
      : tree_(model.tree), inputs_(model.inputs), poses_(given), lost_after_(lost_after) {}

  // The link poses and the number of the state they are from; 0: as given. The address of the poses
  // is constant; only update() writes them.
  [[nodiscard]] ShownDepth::Links links() const noexcept {
    return {&poses_, static_cast<std::uint64_t>(used_)};
  }

  // Recomputes the link poses if a new state was received. No heap; at most k_received_joints_max
  // names and k_robot_joints_max joints, once per image. FollowRobot transforms the model's many
  // points. Requires that no other thread reads the poses meanwhile.
  void update(graph::TripleBuffer<ReceivedJoints>& joint_states) noexcept {
    const std::size_t count = inputs_.size();
    if (count == 0 || !joint_states.sample()) return;
    const std::span<double> positions = std::span(positions_).first(count);
    const std::size_t found = positions_of(joint_states.value(), inputs_, positions);
    if (found < count) {
      ++skipped_;
      if (missing_joint_ == k_none) missing_joint_ = found;
      return;
    }
    const Reason reason = forward_kinematics(tree_, positions, poses_);
    if (reason != Reason::none) {
      ++skipped_;
      if (unusable_ == Reason::none) unusable_ = reason;
      return;
    }
    ++used_;
    arrival_ = Time{joint_states.time_ns()};
  }

  // Returns whether the link poses are valid at `time`, on the clock of the states' arrival. False
  // if joints were received and the state behind the poses is too old.
  [[nodiscard]] bool is_valid_at(Time time) const noexcept {
    return used_ == 0 || time - arrival_ <= lost_after_;
  }

  // Number of states that posed the links, and of states that could not.
  [[nodiscard]] std::int64_t used() const noexcept { return used_; }
  [[nodiscard]] std::int64_t skipped() const noexcept { return skipped_; }
  // First missing joint of the first incomplete state; null: no state was incomplete. Thread-safe,
  // as is unusable().
  [[nodiscard]] const std::string* missing_joint() const noexcept {
    const std::size_t joint = missing_joint_;
    return joint == k_none ? nullptr : &inputs_[joint];
  }
  // Why the first complete but unusable state could not pose the links; Reason::none: all could.
  [[nodiscard]] Reason unusable() const noexcept { return unusable_; }

 private:
  static constexpr std::size_t k_none = SIZE_MAX;

  JointTree tree_;
  std::vector<std::string> inputs_;
  LinkPoses poses_;
  Duration lost_after_;
  Time arrival_;  // of the state behind the poses
  std::array<double, k_robot_joints_max> positions_{};
  std::int64_t used_ = 0, skipped_ = 0;
  std::atomic<std::size_t> missing_joint_{k_none};
  std::atomic<Reason> unusable_{Reason::none};
};

}  // namespace glint
