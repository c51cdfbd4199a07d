// The model of the robot that is followed, at the joint positions that are heard.
//
// The newest state with a position of each of the model's joints counts, whatever else it holds;
// one without changes nothing and is counted. Until the first one, the model stands as it was
// given. From then on it is known only for so long after a state has arrived: by this machine's
// clock, since a stamp is of another's.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include "graph/latest.hpp"
#include "kernels/robot/forward_kinematics.hpp"
#include "kernels/units.hpp"
#include "platform/dds/heard.hpp"
#include "platform/robot/robot_cloud.hpp"

namespace glint {

class HeardRobot {
 public:
  HeardRobot() = default;
  // `posed`: the model at the positions that are given.
  HeardRobot(RobotCloud model, PosedCloud posed, Duration lost_after);

  // What it borrows stays where it is, and is written by update() alone.
  [[nodiscard]] ModelCloud cloud() const { return posed_.cloud(); }

  // Poses the points where something new was heard: two rotations a point, no memory. Nobody may
  // hold the cloud then.
  void update(graph::TripleBuffer<HeardJoints>& heard) noexcept;

  // Whether the points stand as the robot did then, on the clock of the states' arrival: false
  // where joints were heard once, and the last that the points were posed by are too old.
  [[nodiscard]] bool is_known_at(Time time) const noexcept {
    return used_ == 0 || time - arrival_ <= lost_after_;
  }

  // States that the points were posed by, and states that they could not be.
  [[nodiscard]] std::int64_t used() const noexcept { return used_; }
  [[nodiscard]] std::int64_t passed_over() const noexcept { return passed_over_; }
  // The joint that the first of the latter lacked that lacked one; null: none did. Any thread may
  // ask, as for the next.
  [[nodiscard]] const std::string* lacking() const noexcept;
  // Why the first that lacked none could not pose the points; Reason::none: all could.
  [[nodiscard]] Reason unusable() const noexcept { return unusable_; }

 private:
  static constexpr std::size_t k_none = SIZE_MAX;

  RobotCloud model_;
  PosedCloud posed_;
  Duration lost_after_;
  LinkPoses poses_;
  Time arrival_;  // of the state that the points were posed by
  std::array<double, k_robot_joints_max> positions_{};
  std::int64_t used_ = 0, passed_over_ = 0;
  std::atomic<std::size_t> lacking_{k_none};
  std::atomic<Reason> unusable_{Reason::none};
};

}  // namespace glint
