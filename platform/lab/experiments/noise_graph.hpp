// Fresh and gross poses of the shipped marker graph for one tool in range noise and strays.
//
// The frames are those of the experiment noise (noisy_frame.hpp): points of an AHAT camera, new
// strays in each frame. Settings: the built-in cell's; the oracle's declare the true noise.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/reason.hpp"
#include "platform/lab/experiments/point_view.hpp"

namespace glint {

enum class GraphStart {
  once,       // one tracker, a tool in a moving hand
  each_frame  // a new tracker and a new pose for each frame
};

struct GraphNoiseCase {
  PointTool tool;
  ObservationNoise noise;
  int strays = 0;
  GraphStart start = GraphStart::once;
  bool oracle = false;
};

struct GraphNoiseTally {
  std::int64_t trackable = 0;  // three or more markers project into the image
  std::int64_t fresh = 0;      // of these frames, with an accepted pose
  std::int64_t gross = 0;      // accepted poses
  std::array<std::int64_t, static_cast<std::size_t>(k_last_reason) + 1> missed{};  // by reason
};

[[nodiscard]] GraphNoiseTally run_noise_graph(const GraphNoiseCase& one, int frames,
                                              std::uint64_t seed);

}  // namespace glint
