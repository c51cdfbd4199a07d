// Where a body is at any time: a pure function, so that frames may be rendered in any order.
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

// At rest.
[[nodiscard]] MotionPointer fixed_motion(const Pose& pose);

// T_parent_child(t) = parent(t) * child(t): e.g. a pen whose motion is given in the camera's frame.
[[nodiscard]] MotionPointer attached_motion(MotionPointer parent, MotionPointer child);

// 0 before begin, 1 after begin + length, smooth to the second derivative between.
[[nodiscard]] double smooth_step(double seconds, double begin, double length);

}  // namespace glint::sim
