// Glint's motion filter and prediction as a Predictor, with the built-in settings.
#pragma once

#include "kernels/motion/integrate_motion.hpp"
#include "kernels/motion/tool_motion.hpp"
#include "platform/lab/experiments/predictor.hpp"

namespace glint {

class GlintPredictor final : public Predictor {
 public:
  // Throws std::runtime_error if SUNDIALS cannot be prepared.
  explicit GlintPredictor(const ToolMotionSettings& settings = {});
  void update(const UncertainPose& measured) override;
  [[nodiscard]] Pose predict(Time time) const override;

 private:
  ToolMotion motion_;
  MotionState state_;
  mutable MotionIntegrator integrator_;  // workspace
};

}  // namespace glint
