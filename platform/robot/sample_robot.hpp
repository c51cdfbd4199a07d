// Points over a robot's surface, evenly by area.
#pragma once

#include "platform/robot/robot_cloud.hpp"
#include "platform/robot/robot_model.hpp"

namespace glint {

// So many points: the surface, triangle by triangle, is cut into as many parts of equal area, and
// each part has a point at a random place of it (by counter: the same model gives the same points).
// Throws InputError: no points, or more than k_model_points_max.
[[nodiscard]] RobotCloud sample_robot(const RobotModel& robot, int points);

}  // namespace glint
