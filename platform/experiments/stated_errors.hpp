// Devices and tools whose errors are as large as stated, or one of them four times that.
#pragma once

#include <cstdint>

#include "platform/cells/cell.hpp"
#include "platform/sim/scenario.hpp"

namespace glint {

inline constexpr double k_large_sigmas = 4;

enum class LargeError {
  nothing,
  range_offset,
  range_scale,
  tool_geometry,
  principal_point,
  focal_length,
  time_offset,  // of the head's poses against the frames
  head_drift
};

// Draws the errors of device, tools, stamps and headset anew: even, below one stated standard
// deviation, where the scenario's own are of the stated distributions; one may be of
// k_large_sigmas.
void draw_below_one_sigma(const Cell& cell, LargeError large, std::uint64_t seed,
                          sim::Scenario& scenario);

// The headset's own error, by this factor of what it is.
void scale_drift(double factor, sim::LocalisationSettings& head);
// By this factor of what is declared.
void set_drift(double factor, sim::LocalisationSettings& head);

}  // namespace glint
