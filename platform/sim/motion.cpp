#include "platform/sim/motion.hpp"

#include <utility>

namespace glint::sim {
namespace {

class FixedMotion final : public Motion {
 public:
  explicit FixedMotion(const Pose& pose) : pose_(pose) {}
  [[nodiscard]] Pose pose(Time) const override { return pose_; }

 private:
  Pose pose_;
};

class AttachedMotion final : public Motion {
 public:
  AttachedMotion(MotionPointer parent, MotionPointer child)
      : parent_(std::move(parent)), child_(std::move(child)) {}
  [[nodiscard]] Pose pose(Time time) const override {
    return parent_->pose(time) * child_->pose(time);
  }

 private:
  MotionPointer parent_, child_;
};

}  // namespace

MotionPointer fixed_motion(const Pose& pose) { return std::make_shared<FixedMotion>(pose); }

MotionPointer attached_motion(MotionPointer parent, MotionPointer child) {
  return std::make_shared<AttachedMotion>(std::move(parent), std::move(child));
}

double smooth_step(double seconds, double begin, double length) {
  const double u = (seconds - begin) / length;
  if (!(u > 0)) return 0;
  if (u >= 1) return 1;
  return u * u * u * (u * (u * 6 - 15) + 10);
}

}  // namespace glint::sim
