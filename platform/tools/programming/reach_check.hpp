// Checks the points of a path with a robot's kinematics before its program is written: workspace,
// inverse kinematics, joint limits, singularities and continuity along strokes.
//
// Method: Orocos KDL's Newton-Raphson solver from a declared number of random initial guesses. A
// stroke is followed from point to point in each configuration found at its first point, until one
// has no fault; the configuration with the fewest faults is reported. Not checked: the motion
// between points (path_motion.hpp), collisions (collision_check.hpp), speeds of joints.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/tools/programming/inverse_kinematics.hpp"
#include "platform/tools/programming/path.hpp"

namespace glint {

struct PathCheckSettings {
  std::vector<double> start;  // joint positions, the first initial guess; empty: none
  // Smallest singular value of the Jacobian with lengths in units of the chain's reach.
  double singular_value_min = 0.02;
  double joint_step_max = 0.5;                       // rad or m between two points of a stroke
  std::optional<std::array<double, 6>> workspace_m;  // x, y, z minimum, then maximum
  int guesses_max = 64;                              // random initial guesses at one point
  SolverSettings solver;
};

enum class ReachFault : std::uint8_t {
  outside_workspace,
  unreachable,
  joint_limit,
  singular,
  joint_step
};

struct ReachFailure {
  std::size_t element = 0, point = 0;  // from 1
  ReachFault fault = ReachFault::unreachable;
  std::string joint;  // of joint_limit and joint_step
};

// Joint positions at the points of an element; none where the point failed.
using ElementJoints = std::vector<std::optional<KDL::JntArray>>;

struct FollowedPath {
  std::vector<ReachFailure> failures;  // in the order of the path
  std::vector<ElementJoints> joints;   // one entry for each element
};

// The same path gives the same result. Throws InputError for a `start` of another size than
// chain.joints.
[[nodiscard]] FollowedPath follow_path(const DrawnPath& path, const KinematicChain& chain,
                                       const PathCheckSettings& settings);
[[nodiscard]] std::vector<ReachFailure> check_reach(const DrawnPath& path,
                                                    const KinematicChain& chain,
                                                    const PathCheckSettings& settings);

// "stroke 3, point 7".
[[nodiscard]] std::string point_text(const DrawnPath& path, std::size_t element, std::size_t point);

// "stroke 3, point 7: joint limit of elbow".
[[nodiscard]] std::string failure_text(const DrawnPath& path, const ReachFailure& failure);

}  // namespace glint
