// How the robot that is followed stands, by the joint positions that are heard.
//
// The newest state with a position of each of the model's joints counts, whatever else it holds;
// one without changes nothing and is counted. Until the first one, the robot stands as it was
// given. From then on it is known only for so long after a state has arrived: by this machine's
// clock, since a stamp is of another's.
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
#include "platform/dds/heard.hpp"
#include "platform/robot/robot_cloud.hpp"

namespace glint {

class HeardRobot {
 public:
  HeardRobot() = default;
  // `given`: where the model's links are until joints are heard.
  HeardRobot(const RobotCloud& model, const LinkPoses& given, Duration lost_after)
      : tree_(model.tree), inputs_(model.inputs), poses_(given), lost_after_(lost_after) {}

  // Where the links are, and of which state: 0 as given. The poses stay in their place and are
  // written by update() alone.
  [[nodiscard]] ShownDepth::Links links() const noexcept {
    return {&poses_, static_cast<std::uint64_t>(used_)};
  }

  // Finds the links anew where something new was heard, without memory: k_heard_joints_max names
  // and k_robot_joints_max joints at most, once a picture. The model's points, which are many, are
  // FollowRobot's to pose. Nobody may hold the poses then.
  void update(graph::TripleBuffer<HeardJoints>& heard) noexcept {
    const std::size_t count = inputs_.size();
    if (count == 0 || !heard.sample()) return;
    const std::span<double> positions = std::span(positions_).first(count);
    const std::size_t found = positions_of(heard.value(), inputs_, positions);
    if (found < count) {
      ++passed_over_;
      if (lacking_ == k_none) lacking_ = found;
      return;
    }
    const Reason reason = forward_kinematics(tree_, positions, poses_);
    if (reason != Reason::none) {
      ++passed_over_;
      if (unusable_ == Reason::none) unusable_ = reason;
      return;
    }
    ++used_;
    arrival_ = Time{heard.time_ns()};
  }

  // Whether the links are where the robot's were then, on the clock of the states' arrival: false
  // where joints were heard once, and the last that the poses are of are too old.
  [[nodiscard]] bool is_known_at(Time time) const noexcept {
    return used_ == 0 || time - arrival_ <= lost_after_;
  }

  // States that the links were posed by, and states that they could not be.
  [[nodiscard]] std::int64_t used() const noexcept { return used_; }
  [[nodiscard]] std::int64_t passed_over() const noexcept { return passed_over_; }
  // The joint that the first of the latter lacked that lacked one; null: none did. Any thread may
  // ask, as for the next.
  [[nodiscard]] const std::string* lacking() const noexcept {
    const std::size_t joint = lacking_;
    return joint == k_none ? nullptr : &inputs_[joint];
  }
  // Why the first that lacked none could not pose the links; Reason::none: all could.
  [[nodiscard]] Reason unusable() const noexcept { return unusable_; }

 private:
  static constexpr std::size_t k_none = SIZE_MAX;

  JointTree tree_;
  std::vector<std::string> inputs_;
  LinkPoses poses_;
  Duration lost_after_;
  Time arrival_;  // of the state that the poses are of
  std::array<double, k_robot_joints_max> positions_{};
  std::int64_t used_ = 0, passed_over_ = 0;
  std::atomic<std::size_t> lacking_{k_none};
  std::atomic<Reason> unusable_{Reason::none};
};

}  // namespace glint
