// Bright spots painted into rendered frames: hot pixels, reflections, textures that no tool has.
//
// They are drawn as plain discs into the pixels, by a generator of their own: the simulator's
// strays are balls in its scene, and a tracker that is good with the one may fail with the other.
// A spot that would touch one of the tools' markers is left out of that frame, as if it were hidden
// behind the hand, so that the truth's visible markers stay visible; single pixels stay everywhere.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/geometry.hpp"
#include "kernels/pose/tool.hpp"
#include "platform/sensors/camera.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {

struct SpotSettings {
  int count = 0;
  double radius_min_px = 0, radius_max_px = 0;  // 0: a single pixel, whose depth stays
  int level_min = 3000, level_max = 60'000;     // reflectivity, raw
  int depth_min_mm = 300, depth_max_mm = 950;
  int clusters = 0;          // 0: anywhere in the frame
  double cluster_px = 40;    // spots lie within this of their cluster's middle, along each axis
  double speed_px_s = 0;     // each in a direction of its own; those that leave come back in
  double flicker_share = 0;  // of the frames in which a spot is not there
};

class PaintedSpots {
 public:
  PaintedSpots(const SpotSettings& settings, const Camera& camera, std::uint64_t seed);

  // Paints the spots of a frame over its pixels. Returns how many.
  int paint(const ToolSet& tools, sim::SimFrame& frame) const;

 private:
  struct Spot {
    Vector2 place_px = Vector2::Zero(), velocity_px_s = Vector2::Zero();
    double radius_px = 0;
    std::uint16_t level = 0, depth = 0;
  };

  SpotSettings settings_;
  Camera camera_;
  std::uint64_t seed_;
  std::vector<Spot> spots_;
};

}  // namespace glint
