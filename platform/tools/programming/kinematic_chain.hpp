// Chain of a URDF's joints from the root to a link, as Orocos KDL solves it, with joint limits.
#pragma once

#include <kdl/chain.hpp>
#include <string>
#include <vector>

namespace glint {

struct KinematicChain {
  std::string robot, tip;
  KDL::Chain chain;
  std::vector<std::string> joints;   // that move, from the root on
  std::vector<double> lower, upper;  // radians or metres; continuous: -infinity, infinity
  std::vector<bool> revolute;        // includes continuous
  double reach_m = 0;                // sum of the joints' offsets and of the prismatic strokes
};

// Meshes are not read. Throws InputError for an invalid URDF, an unknown link, a chain without a
// moving joint, with a mimic, planar or floating joint, or with limits that are not ascending.
[[nodiscard]] KinematicChain read_chain(const std::string& urdf, const std::string& tip);

}  // namespace glint
