// Integer sums and products that never wrap around.
#pragma once

#include <cstdint>
#include <stdexcept>

namespace glint::prove {

// Both throw std::overflow_error beyond 63 bits.
[[nodiscard]] inline std::int64_t exact_sum(std::int64_t a, std::int64_t b) {
  std::int64_t sum = 0;
  if (__builtin_add_overflow(a, b, &sum)) throw std::overflow_error("a count above 2^63");
  return sum;
}
[[nodiscard]] inline std::int64_t exact_product(std::int64_t a, std::int64_t b) {
  std::int64_t product = 0;
  if (__builtin_mul_overflow(a, b, &product)) throw std::overflow_error("a count above 2^63");
  return product;
}

}  // namespace glint::prove
