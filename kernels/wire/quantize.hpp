// Quantisation of SI values to the integers of a wire format, with range check.
//
// What:     nearest integer, half away from zero; returns fits = false for NaN or out of range.
// Cost:     a multiplication, a floor and two comparisons.
// Worst:    any double, infinities and NaN included.
// Accuracy: exact: the nearest integer to the double product.
// Source:   own code, because libm's nearbyint depends on the rounding mode of the process.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "kernels/geometry.hpp"

namespace glint {

struct Quantized {
  std::int64_t value = 0;  // 0 if it does not fit
  bool fits = false;
};

// Returns round(value * per_unit) if it is in [low, high]. Requires |low|, |high| < 2^53.
[[nodiscard]] inline Quantized quantize(double value, double per_unit, std::int64_t low,
                                        std::int64_t high) noexcept {
  const double scaled = value * per_unit;
  const double size = std::abs(scaled);
  if (!(size < 0x1p53)) return {};
  const auto below = static_cast<double>(static_cast<std::int64_t>(size));  // floor may be a call
  const double nearest = size - below >= 0.5 ? below + 1 : below;
  const auto whole = static_cast<std::int64_t>(scaled < 0 ? -nearest : nearest);
  if (whole < low || whole > high) return {};
  return {whole, true};
}

// For values of which larger is worse, such as a standard deviation. Returns `over` ("this or more,
// or unknown") if the value does not fit below it.
[[nodiscard]] inline std::uint64_t quantize_or(double value, double per_unit,
                                               std::uint64_t over) noexcept {
  const Quantized q = quantize(value, per_unit, 0, static_cast<std::int64_t>(over) - 1);
  return q.fits ? static_cast<std::uint64_t>(q.value) : over;
}

struct QuantizedVector {
  std::array<std::int64_t, 3> value{};  // all 0 if one of them does not fit
  bool fits = false;
};

[[nodiscard]] inline QuantizedVector quantize(const Vector3& vector, double per_unit,
                                              std::int64_t low, std::int64_t high) noexcept {
  QuantizedVector result;
  for (int axis = 0; axis < 3; ++axis) {
    const Quantized q = quantize(vector[axis], per_unit, low, high);
    if (!q.fits) return {};
    result.value[static_cast<std::size_t>(axis)] = q.value;
  }
  result.fits = true;
  return result;
}

}  // namespace glint
