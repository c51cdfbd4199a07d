#include "platform/session/heard_robot.hpp"

#include <algorithm>
#include <utility>

namespace glint {

HeardRobot::HeardRobot(RobotCloud model, PosedCloud posed)
    : model_(std::move(model)), posed_(std::move(posed)) {}

void HeardRobot::update(graph::TripleBuffer<HeardJoints>& heard) noexcept {
  const std::size_t count = model_.inputs.size();
  if (count == 0 || !heard.sample()) return;
  const std::span<double> positions = std::span(positions_).first(count);
  const std::size_t found = positions_of(heard.value(), model_.inputs, positions);
  if (found < count || forward_kinematics(model_.tree, positions, poses_) != Reason::none) {
    ++passed_over_;
    std::size_t none = k_none;
    (void)lacking_.compare_exchange_strong(none, std::min(found, count - 1));
    return;
  }
  ++used_;
  (void)pose_cloud(model_.cloud(), poses_, posed_.points, posed_.normals);  // as it was when given
}

const std::string* HeardRobot::lacking() const noexcept {
  const std::size_t joint = lacking_;
  return joint == k_none ? nullptr : &model_.inputs[joint];
}

}  // namespace glint
