// Variance inflation of AR(1) residuals, from their lag-one autocorrelation.
#pragma once

#include <algorithm>
#include <span>

#include "kernels/geometry.hpp"

namespace glint {

// Returns (1 + r) / (1 - r) of a first-order process with correlation r between neighbours; 1 if r
// is not significant (2 sigma). Source: Bartlett 1946, Journal of the Royal Statistical Society
// supplement 8, p. 27.
[[nodiscard]] inline double correlation_factor(std::span<const Vector3> misses) {
  double products = 0, squares = 0;
  for (std::size_t i = 0; i < misses.size(); ++i) {
    squares += misses[i].squaredNorm();
    if (i > 0) products += misses[i].dot(misses[i - 1]);
  }
  const double r = squares > 0 ? std::min(products / squares, 0.99) : 0;
  const bool by_chance = r * r * 3.0 * static_cast<double>(misses.size()) < 4;
  return r > 0 && !by_chance ? (1 + r) / (1 - r) : 1;
}

}  // namespace glint
