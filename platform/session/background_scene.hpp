// What a background looks at and for, read from the files that its cell names.
#pragma once

#include "platform/cells/cell.hpp"
#include "platform/robot/robot_cloud.hpp"
#include "platform/session/depth_loop.hpp"

namespace glint {

struct BackgroundScene {
  DepthLoop pictures;
  RobotCloud model;
  LinkPoses poses;  // of the model's links, at the cell's joints
};

// Empty where the cell has no [mapping]. Throws InputError naming the file that is missing or
// wrong; with `png` null a PNG is.
[[nodiscard]] BackgroundScene read_background_scene(const Cell& cell, DepthPngReader png);

}  // namespace glint
