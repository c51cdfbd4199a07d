// Configures the graphs from a cell: the only place that converts user settings to node settings.
#pragma once

#include "nodes/output.hpp"
#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"

namespace glint {

// Throw std::logic_error if a node's prepare() fails; require a validated cell.
void configure(const Cell& cell, Tracker& tracker);
void configure(const Cell& cell, MarkerTracker& tracker);
void configure(const Cell& cell, Output& output);

// The cell's declared marker noise and its lens.
[[nodiscard]] MarkerNoise declared_noise(const Camera& camera) noexcept;
// The cell's declared pose of the robot.
[[nodiscard]] RobotFrame declared_robot_frame(const Cell& cell);

}  // namespace glint
