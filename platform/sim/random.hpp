// Counter-based random numbers: a value depends only on (seed, stream, index). Frames can be
// rendered in any order, by any thread, on any machine, with the same bytes.
//
// Source: SplitMix64's finalizer (Steele, Lea, Flood 2014, Fast splittable pseudorandom number
// generators, figure 16), applied to each key in turn; normal values by Box and Muller 1958.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/geometry.hpp"

namespace glint::sim {

// Purpose of a random stream; streams are independent.
enum class Stream : std::uint64_t {
  noise_table = 1,
  row_offset = 2,
  blob = 3,
  transport = 4,
  hand = 5,
  tremor = 6,
  head = 7,
  localisation = 8,
  reference = 9,
  room = 10,
  points = 11,
  long_throw = 12,
  device = 13,
  field = 14,
  touches = 15,
  chessboard = 16,
};

[[nodiscard]] constexpr std::uint64_t splitmix64(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15u;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return x ^ (x >> 31);
}

struct RandomKey {
  std::uint64_t seed = 0;
  Stream stream = Stream::noise_table;
  std::uint64_t instance = 0;  // e.g. index of a tool

  [[nodiscard]] constexpr std::uint64_t bits(std::uint64_t index) const {
    const std::uint64_t key = splitmix64(splitmix64(seed) ^ static_cast<std::uint64_t>(stream));
    return splitmix64(splitmix64(key ^ instance) ^ index);
  }
};

// Uniform in (0, 1), without the ends.
[[nodiscard]] double uniform(const RandomKey& key, std::uint64_t index);

// Standard normal; |value| < 8.6.
[[nodiscard]] double gaussian(const RandomKey& key, std::uint64_t index);
[[nodiscard]] Vector3 gaussian_vector(const RandomKey& key, std::uint64_t index);

// Returns `count` normal values (at least 2) with sample mean 0 and sample standard deviation 1.
// The table is reused, so its own mean would bias every frame by the same amount.
[[nodiscard]] std::vector<float> gaussian_table(const RandomKey& key, int count);

}  // namespace glint::sim
