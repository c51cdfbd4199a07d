// Counter-based random numbers for inputs: the same on every machine, in any order.
#pragma once

#include <cstdint>

#include "platform/budget/measured_kernel.hpp"

namespace glint {

// SplitMix64 (Steele, Lea, Flood 2014, fig. 13), with an initial state from purpose, kind and
// number.
class CounterRandom {
 public:
  CounterRandom(std::uint64_t purpose, InputKind kind, std::uint64_t number)
      : state_((purpose << 56) + (static_cast<std::uint64_t>(kind) << 48) +
               number * 0x9E3779B97F4A7C15u) {
    bits();
  }

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  // 0 .. n - 1
  int below(int n) { return static_cast<int>(bits() % static_cast<std::uint64_t>(n)); }
  // from .. to
  int between(int from, int to) { return from + below(to - from + 1); }
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

 private:
  std::uint64_t state_;
};

}  // namespace glint
