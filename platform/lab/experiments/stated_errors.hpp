// Simulated devices and tools whose errors are as large as stated, or one of them four times that.
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
  time_offset,  // of the head poses relative to the frames
  head_drift
};

// Draws the errors of device, tools, time stamps and headset again: uniform, below one stated
// standard deviation, in place of the scenario's own from the stated distributions. One error may
// have k_large_sigmas.
void draw_below_one_sigma(const Cell& cell, LargeError large, std::uint64_t seed,
                          sim::Scenario& scenario);

// Multiplies the headset's own error by this factor.
void scale_drift(double factor, sim::LocalisationSettings& head);
// Sets it to this factor times the declared one.
void set_drift_factor(double factor, sim::LocalisationSettings& head);

}  // namespace glint
