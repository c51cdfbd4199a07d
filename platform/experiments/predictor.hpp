// Whoever says from noisy poses where a tool will be: Glint's filter and its rivals, alike.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernels/motion/motion_state.hpp"

namespace glint {

class Predictor {
 public:
  virtual ~Predictor() = default;
  // Stamps rise.
  virtual void update(const UncertainPose& measured) = 0;
  // After at least one update; time: that of the newest measurement or later.
  [[nodiscard]] virtual Pose predict(Time time) const = 0;
};

using PredictorPointer = std::unique_ptr<Predictor>;

struct NamedPredictor {
  std::string name;
  PredictorPointer (*make)();
};

}  // namespace glint
