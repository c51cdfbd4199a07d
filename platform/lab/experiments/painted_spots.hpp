// Bright spots painted into rendered frames: hot pixels, reflections, textures of no tool.
//
// Plain discs drawn into the pixels by an independent generator. The simulator's false markers are
// balls in its scene; a tracker may pass the one test and fail the other. A spot that would touch a
// tool's marker is omitted from that frame, as if hidden behind the hand, so that the ground
// truth's visible markers stay visible. Single pixels are never omitted.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/geometry.hpp"
#include "kernels/pose/tool.hpp"
#include "platform/formats/camera.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {

struct SpotSettings {
  int count = 0;
  double radius_min_px = 0, radius_max_px = 0;  // 0: a single pixel, whose depth is unchanged
  int level_min = 3000, level_max = 60'000;     // reflectivity, raw
  int depth_min_mm = 300, depth_max_mm = 950;
  int clusters = 0;          // 0: anywhere in the frame
  double cluster_px = 40;    // spots are within this of their cluster's centre, along each axis
  double speed_px_s = 0;     // each in its own direction; wraps around at the frame's edges
  double flicker_share = 0;  // fraction of the frames in which a spot is absent
};

class PaintedSpots {
 public:
  PaintedSpots(const SpotSettings& settings, const Camera& camera, std::uint64_t seed);

  // Paints the spots of a frame over its pixels. Returns their number.
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
