// Depth format of a sensor: the simulator writes it, back-projection reads it.
#pragma once

#include <cstdint>

#include "kernels/pose/depth_bias.hpp"

namespace glint {

enum class DepthKind : std::uint8_t {
  radial,  // along the pixel's ray (HoloLens 1 and 2)
  z,       // along the optical axis
};

struct DepthSettings {
  DepthKind kind = DepthKind::radial;
  double unit_m = 0.001;                  // metres per raw count
  std::uint16_t invalid_from = 4090;      // raw values from here on are invalid, like 0
  double wrap_range_m = 0;                // ranges wrap at this distance; 0: they do not
  std::uint16_t saturated_from = 0xFFFF;  // reflectivity from here on invalidates the depth
  DepthBias bias;                         // of the tools' markers
  double pixel_sigma_m = 0.004;           // of one pixel's depth, before its spread is observed
};

}  // namespace glint
