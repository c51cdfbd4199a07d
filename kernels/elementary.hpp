// Sine, cosine, natural logarithm, exponential and arc functions with equal bits on every machine.
// libm is excluded from the core: glibc selects variants by CPU, and their bits may differ.
//
// What:     range reduction to a short interval, then a Taylor series with exact coefficients.
// Cost:     no loop, at most one division and one square root; 5 to 25 ns.
// Worst:    accepts any double: clamps a value outside the stated range; treats NaN as zero.
// Accuracy: within 2 units in the last place (arc cosine: 3), measured over 10^6 random arguments
//           against glibc 2.36, itself within 1; see elementary_test.cpp. Sine and cosine next to
//           their zeros: 2e-16 absolute.
// Source:   Taylor series of the functions; the remainder is stated at each series. Reduction in
//           several exact pieces: Cody and Waite 1980, Software Manual for the Elementary
//           Functions.
#pragma once

#include "kernels/nonblocking.hpp"

namespace glint {

struct SineCosine {
  double sine = 0;
  double cosine = 1;
};

// Ranges: sine_cosine |radians| <= 1e5; logarithm x > 0; exponential |x| <= 700; arc_cosine clamps
// to [-1, 1]. arc_tangent is atan2.
[[nodiscard]] SineCosine sine_cosine(double radians) noexcept GLINT_NONBLOCKING;
[[nodiscard]] double logarithm(double x) noexcept GLINT_NONBLOCKING;
[[nodiscard]] double exponential(double x) noexcept GLINT_NONBLOCKING;
[[nodiscard]] double arc_tangent(double y, double x) noexcept GLINT_NONBLOCKING;
[[nodiscard]] double arc_cosine(double x) noexcept GLINT_NONBLOCKING;

}  // namespace glint
