// Sine, cosine, logarithm and arc functions with equal bits on every machine: glibc picks its
// variants by CPU, so the core may not call libm's.
#pragma once

namespace glint {

struct SineCosine {
  double sine = 0;
  double cosine = 1;
};

[[nodiscard]] SineCosine sine_cosine(double radians) noexcept;      // |radians| <= 1e5
[[nodiscard]] double logarithm(double x) noexcept;                  // natural, x > 0
[[nodiscard]] double exponential(double x) noexcept;                // |x| <= 700
[[nodiscard]] double arc_tangent(double y, double x) noexcept;      // atan2
[[nodiscard]] double arc_cosine(double x) noexcept;                 // clamped to [-1, 1]

}  // namespace glint
