// Collisions of a robot's links with an occupancy map and with each other along a path's motion.
//
// Method: FCL (Flexible Collision Library) tests the links' boxes, cylinders and spheres as solids
// and their meshes as surfaces with the occupied voxels of an octomap, at each sample of the
// motion. FCL runs in a separate program, glint_collision_checker: the library is compiled for
// another alignment of Eigen's types, and a fault in it ends that program, not this one.
//
// A link that no joint moves is not tested with the map: it stands where it was built. A voxel
// within a mesh, that its surface does not touch, is not found: counting a ray's crossings needs
// closed meshes, which URDF meshes often are not, and an open one would fail paths that are free. A
// voxel larger than the step is found where it crosses the surface on the way in.
#pragma once

#include <string>
#include <vector>

#include "platform/tools/programming/path_motion.hpp"
#include "platform/tools/robot/robot_model.hpp"

namespace glint {

struct CollisionSettings {
  std::string octomap;                // .bt file, as of `glint map --octomap`
  Pose T_map_robot;                   // the URDF's root in the map
  std::vector<std::string> touching;  // links that may touch the map
  bool links = false;                 // also tests links with each other, if no joint connects them
  Duration time_max = milliseconds(600'000);
};

struct PathCollision {
  std::size_t element = 0, point = 0;  // from 1
  bool at_point = false;               // else on the move to it
  std::string link, other;             // other: empty is the map
};

// In the order of the path; each link once a point. Joints outside of the chain are at position 0.
// Throws InputError for an invalid map and for unknown names, and MissingDevice without the
// program.
[[nodiscard]] std::vector<PathCollision> check_collisions(const PathMotion& motion,
                                                          const RobotModel& robot,
                                                          const KinematicChain& chain,
                                                          const CollisionSettings& settings);

// "stroke 3, point 7: link forearm touches the map".
[[nodiscard]] std::string collision_text(const DrawnPath& path, const PathCollision& collision);

}  // namespace glint
