// Stands in for the background group until mapping is there: a slice of integer work of declared
// length, so that slices can be scheduled, preempted and measured.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "graph/graph.hpp"
#include "graph/loops.hpp"
#include "kernels/limits.hpp"

namespace glint {

struct BackgroundSeed {
  std::uint64_t value = 0;
};
struct BackgroundDigest {
  std::uint64_t value = 0;
};

// Every slice takes the same time, whatever the seed. Each step needs the one before (splitmix64:
// Steele, Lea and Flood 2014), so that no compiler shortens the loop.
struct BackgroundSlice {
  static constexpr std::array<std::string_view, 2> k_loops = {"call", "steps"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return {{1, limits.background_steps}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return {{1, ran_}}; }

  int steps = k_background_steps_max;
  Limits limits;

  void operator()(const BackgroundSeed& seed, BackgroundDigest& digest) noexcept {
    ran_ = std::min(steps, limits.background_steps);
    std::uint64_t z = seed.value;
    for (int step = 0; step < ran_; ++step) {
      z += 0x9E3779B97F4A7C15u;
      z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
      z ^= z >> 27;
    }
    digest.value = z;
  }

 private:
  int ran_ = 0;
};

static_assert(graph::Budgeted<BackgroundSlice, Limits>);

using Background =
    graph::Graph<graph::Inputs<BackgroundSeed>, graph::Outputs<BackgroundDigest>, BackgroundSlice>;
static_assert(graph::valid<Background>);

}  // namespace glint
