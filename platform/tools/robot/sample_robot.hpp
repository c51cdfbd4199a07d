// Uniform sampling of points on a robot's surface.
#pragma once

#include "platform/tools/robot/robot_cloud.hpp"
#include "platform/tools/robot/robot_model.hpp"

namespace glint {

// Stratified sampling: divides the surface, triangle by triangle, into `points` parts of equal area
// and places one point at random in each (counter-based: the same model yields the same points).
// Throws InputError for no points or more than k_model_points_max.
[[nodiscard]] RobotCloud sample_robot(const RobotModel& robot, int points);

}  // namespace glint
