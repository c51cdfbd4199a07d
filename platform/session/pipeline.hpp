// Sets up the graphs from a cell: the one place where a user's settings become nodes' settings.
#pragma once

#include "nodes/output.hpp"
#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"

namespace glint {

// Both throw std::logic_error where a node cannot be prepared; the cell was validated before.
void configure(const Cell& cell, Tracker& tracker);
void configure(const Cell& cell, MarkerTracker& tracker);
void configure(const Cell& cell, Output& output);

// What the cell declares of a marker's noise and of the lens.
[[nodiscard]] MarkerNoise declared_noise(const Camera& camera) noexcept;
// The robot's frame that the cell declares.
[[nodiscard]] RobotFrame declared_robot_frame(const Cell& cell);

}  // namespace glint
