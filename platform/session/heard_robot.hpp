// The model of the robot that is followed, at the joint positions that are heard.
//
// The newest state with a position of each of the model's joints counts, whatever else it holds;
// one without changes nothing and is counted. Until the first one, the model stands as it was
// given.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include "graph/latest.hpp"
#include "kernels/robot/forward_kinematics.hpp"
#include "platform/dds/heard.hpp"
#include "platform/robot/robot_cloud.hpp"

namespace glint {

class HeardRobot {
 public:
  HeardRobot() = default;
  // `posed`: the model at the positions that are given.
  HeardRobot(RobotCloud model, PosedCloud posed);

  // What it borrows stays where it is, and is written by update() alone.
  [[nodiscard]] ModelCloud cloud() const { return posed_.cloud(); }

  // Poses the points where something new was heard: two rotations a point, no memory. Nobody may
  // hold the cloud then.
  void update(graph::TripleBuffer<HeardJoints>& heard) noexcept;

  // States that the points were posed by, and states that they could not be.
  [[nodiscard]] std::int64_t used() const noexcept { return used_; }
  [[nodiscard]] std::int64_t passed_over() const noexcept { return passed_over_; }
  // The joint for which one was passed over first; null: none was. Any thread may ask.
  [[nodiscard]] const std::string* lacking() const noexcept;

 private:
  static constexpr std::size_t k_none = SIZE_MAX;

  RobotCloud model_;
  PosedCloud posed_;
  LinkPoses poses_;
  std::array<double, k_robot_joints_max> positions_{};
  std::int64_t used_ = 0, passed_over_ = 0;
  std::atomic<std::size_t> lacking_{k_none};
};

}  // namespace glint
