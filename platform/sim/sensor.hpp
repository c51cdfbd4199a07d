// Sensor model: noise, saturation, wrap and quantisation of a noise-free image.
//
// What:     reflectivity = signal + noise, rounded, clipped at 8 or 16 bit. depth = range + noise,
//           wrapped, in raw units; 0 if the signal is too weak or saturates, if the range exceeds
//           the sensor's, or if the lens maps nothing.
// Cost:     one pass; normal values come from a table, at an offset given by random seed, frame and
//           row.
#pragma once

#include <cstdint>
#include <vector>

#include "platform/formats/camera.hpp"
#include "platform/formats/frame_buffer.hpp"
#include "platform/sim/lens_rays.hpp"
#include "platform/sim/noise.hpp"
#include "platform/sim/planes.hpp"

namespace glint::sim {

class Sensor {
 public:
  Sensor(const Camera& camera, const NoiseSettings& noise, std::uint64_t seed);
  void expose(const Planes& planes, const LensRays& rays, std::uint64_t sequence,
              FrameBuffer& out) const;

 private:
  Camera camera_;
  NoiseSettings noise_;
  std::uint64_t seed_ = 0;
  std::vector<float> table_;
};

}  // namespace glint::sim
