#include "platform/lab/experiments/glint_predictor.hpp"

#include <stdexcept>

namespace glint {

GlintPredictor::GlintPredictor(const ToolMotionSettings& settings) {
  motion_.settings = settings;
  if (integrator_.prepare(settings.motion) != Reason::none)
    throw std::runtime_error("SUNDIALS cannot be prepared: no memory");
}

void GlintPredictor::update(const UncertainPose& measured) {
  if (motion_.update(measured) == Reason::none) state_ = motion_.estimate();
}

Pose GlintPredictor::predict(Time time) const {
  return integrator_.after(state_, time - state_.time).value.pose;
}

}  // namespace glint
