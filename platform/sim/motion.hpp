// Motion of a body: pose as a pure function of time, so that frames can be rendered in any order.
#pragma once

#include <memory>

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"

namespace glint::sim {

class Motion {
 public:
  virtual ~Motion() = default;
  [[nodiscard]] virtual Pose pose(Time time) const = 0;  // T_parent_body
};

using MotionPointer = std::shared_ptr<const Motion>;

// Constant pose.
[[nodiscard]] MotionPointer fixed_motion(const Pose& pose);

// T_parent_child(t) = parent(t) * child(t), e.g. for a pen with its motion in the camera's frame.
[[nodiscard]] MotionPointer attached_motion(MotionPointer parent, MotionPointer child);

// Quintic step: 0 before begin, 1 after begin + length, continuous second derivative.
[[nodiscard]] double smooth_step(double seconds, double begin, double length);

}  // namespace glint::sim
