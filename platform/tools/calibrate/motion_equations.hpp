// Propagation of the filter's mean and covariance (kernels/motion) between two measurements, with
// forward sensitivities to noise and damping, by CVODES.
//
// Handles translation and rotation separately, since they are decoupled:
//   position' = velocity,  velocity' = acceleration,  acceleration' = -damping acceleration
//   P' = F P + P F' + Q,  F the same for the errors; of a rotation also (angular speed) x error.
// The position of a rotation is the rotation vector since the last measurement.
//
// Source: Hindmarsh et al. 2005, SUNDIALS, ACM TOMS 31(3): CVODES, simultaneous sensitivities;
//         the model: kernels/motion/singer.hpp.
#pragma once

#include <array>
#include <memory>

#include "kernels/geometry.hpp"

namespace glint {

enum class MotionPart { shift, rotation };

using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

// Position, velocity, acceleration: three components each; SI units.
struct Moments {
  Vector9 mean = Vector9::Zero();
  Matrix9 covariance = Matrix9::Zero();
};

// Sensitivities to the logarithms of the noise density and of the damping.
inline constexpr int k_motion_unknowns = 2;
struct SensitiveMoments {
  Moments value;
  std::array<Moments, k_motion_unknowns> by;
};

struct MotionUnknowns {
  double noise = 1;    // density of the driving noise of the acceleration
  double damping = 1;  // 1/s
};

class MotionEquations {
 public:
  // Throws std::runtime_error if SUNDIALS cannot be initialised.
  explicit MotionEquations(MotionPart part);
  ~MotionEquations();
  MotionEquations(const MotionEquations&) = delete;
  MotionEquations& operator=(const MotionEquations&) = delete;

  // Propagates the moments by `seconds`. Returns false if the integration fails (extreme unknowns).
  [[nodiscard]] bool propagate(SensitiveMoments& moments, double seconds,
                               const MotionUnknowns& unknowns);

 private:
  struct Body;
  std::unique_ptr<Body> body_;
};

}  // namespace glint
