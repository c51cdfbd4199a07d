#include "platform/session/heard_robot.hpp"

#include <utility>

namespace glint {

HeardRobot::HeardRobot(RobotCloud model, PosedCloud posed, Duration lost_after)
    : model_(std::move(model)), posed_(std::move(posed)), lost_after_(lost_after) {}

void HeardRobot::update(graph::TripleBuffer<HeardJoints>& heard) noexcept {
  const std::size_t count = model_.inputs.size();
  if (count == 0 || !heard.sample()) return;
  const std::span<double> positions = std::span(positions_).first(count);
  const std::size_t found = positions_of(heard.value(), model_.inputs, positions);
  if (found < count) {
    ++passed_over_;
    if (lacking_ == k_none) lacking_ = found;
    return;
  }
  const Reason reason = forward_kinematics(model_.tree, positions, poses_);
  if (reason != Reason::none) {
    ++passed_over_;
    if (unusable_ == Reason::none) unusable_ = reason;
    return;
  }
  ++used_;
  arrival_ = Time{heard.time_ns()};
  (void)pose_cloud(model_.cloud(), poses_, posed_.points, posed_.normals);  // as it was when given
}

const std::string* HeardRobot::lacking() const noexcept {
  const std::size_t joint = lacking_;
  return joint == k_none ? nullptr : &model_.inputs[joint];
}

}  // namespace glint
