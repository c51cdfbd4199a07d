// Interface of pose predictors from noisy poses: Glint's filter and the baseline predictors.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernels/motion/motion_state.hpp"

namespace glint {

class Predictor {
 public:
  virtual ~Predictor() = default;
  // Requires increasing time stamps.
  virtual void update(const UncertainPose& measured) = 0;
  // Requires at least one update and a time not before the newest measurement.
  [[nodiscard]] virtual Pose predict(Time time) const = 0;
};

using PredictorPointer = std::unique_ptr<Predictor>;

struct NamedPredictor {
  std::string name;
  PredictorPointer (*make)();
};

}  // namespace glint
