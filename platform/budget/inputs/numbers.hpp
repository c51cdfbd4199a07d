// Random numbers of an input, from its kind and number only: the same on every machine.
#pragma once

#include <cmath>
#include <cstdint>

#include "kernels/elementary.hpp"
#include "kernels/geometry.hpp"
#include "platform/budget/measured_kernel.hpp"

namespace glint::inputs {

// SplitMix64 (Steele, Lea and Flood 2014).
class Numbers {
 public:
  Numbers(InputKind kind, std::uint64_t number)
      : state_((number * 4 + static_cast<std::uint64_t>(kind) + 1) * 0x9E3779B97F4A7C15u) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  // 0 .. count - 1
  int below(int count) { return static_cast<int>(bits() % static_cast<std::uint64_t>(count)); }
  bool one_in(int count) { return below(count) == 0; }
  double within(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
  }
  // Sum of twelve uniform numbers: approximately normal, without a logarithm.
  double normal() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += within(0, 1);
    return sum;
  }
  Vector3 in_box(double side) {
    const double x = within(-side / 2, side / 2);
    const double y = within(-side / 2, side / 2);
    return {x, y, within(-side / 2, side / 2)};
  }
  Quaternion rotation() {
    const double w = normal(), x = normal(), y = normal(), z = normal();
    const Quaternion q(w, x, y, z);
    return q.norm() > 1e-3 ? q.normalized() : Quaternion::Identity();
  }

 private:
  std::uint64_t state_;
};

}  // namespace glint::inputs
