// A hand's motion between two measurements, and how it hangs on noise and damping: the mean and
// covariance equations of the filter (kernels/motion) with their forward sensitivities, by CVODES.
//
// One part at a time, shift or rotation, for neither acts on the other:
//   place' = speed,  speed' = acceleration,  acceleration' = -damping acceleration
//   P' = F P + P F' + Q,  F the same for the errors; of a rotation also (angular speed) x error.
// The place of a rotation is the rotation vector since the last measurement.
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

// Place, speed, acceleration: three each; SI.
struct Moments {
  Vector9 mean = Vector9::Zero();
  Matrix9 covariance = Matrix9::Zero();
};

// By the logarithms: of the noise's density, of the damping.
inline constexpr int k_motion_unknowns = 2;
struct SensitiveMoments {
  Moments value;
  std::array<Moments, k_motion_unknowns> by;
};

struct MotionUnknowns {
  double noise = 1;    // density of the acceleration's driving noise
  double damping = 1;  // 1/s
};

class MotionEquations {
 public:
  // Throws std::runtime_error where SUNDIALS cannot be prepared.
  explicit MotionEquations(MotionPart part);
  ~MotionEquations();
  MotionEquations(const MotionEquations&) = delete;
  MotionEquations& operator=(const MotionEquations&) = delete;

  // Carries the moments on. False: the equations could not be integrated (unknowns beyond reason).
  [[nodiscard]] bool carry(SensitiveMoments& moments, double seconds,
                           const MotionUnknowns& unknowns);

 private:
  struct Body;
  std::unique_ptr<Body> body_;
};

}  // namespace glint
