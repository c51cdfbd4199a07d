// Chi-square limits for the test of a fit's residuals, at significance level 1e-4.
//
// Source:   the quantiles of the chi-square distribution at 1 - 1e-4, from its closed forms
//           (Abramowitz and Stegun 1964, 26.4.4 and 26.4.5), solved by bisection.
#pragma once

#include <algorithm>
#include <array>

namespace glint {

inline constexpr double k_chi_square_tail = 1e-4;

// Returns 0 for no degrees of freedom; beyond 24, three for each of 8 markers, the limit of 24.
[[nodiscard]] constexpr double chi_square_limit(int degrees_of_freedom) {
  constexpr std::array<double, 25> limits = {
      0,       15.1367, 18.4207, 21.1075, 23.5127, 25.7448, 27.8563, 29.8775, 31.8276,
      33.7199, 35.5640, 37.3670, 39.1344, 40.8707, 42.5793, 44.2632, 45.9249, 47.5664,
      49.1894, 50.7955, 52.3860, 53.9620, 55.5246, 57.0746, 58.6130};
  return limits[static_cast<std::size_t>(std::clamp(degrees_of_freedom, 0, 24))];
}

}  // namespace glint
