#include "platform/session/heard_robot.hpp"

namespace glint {

HeardRobot::HeardRobot(const RobotCloud& model, const LinkPoses& given, Duration lost_after)
    : tree_(model.tree), inputs_(model.inputs), poses_(given), lost_after_(lost_after) {}

void HeardRobot::update(graph::TripleBuffer<HeardJoints>& heard) noexcept {
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

const std::string* HeardRobot::lacking() const noexcept {
  const std::size_t joint = lacking_;
  return joint == k_none ? nullptr : &inputs_[joint];
}

}  // namespace glint
