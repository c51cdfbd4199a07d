// Joint positions for a pose of a chain's tip by Orocos KDL, with limits and distance to a
// singularity.
//
// KDL's Newton-Raphson solver with damped least squares. Its Levenberg-Marquardt solver is not
// used: it contains a fixed-size Eigen matrix, whose alignment differs with EIGEN_DONT_VECTORIZE.
#pragma once

#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_nr.hpp>
#include <kdl/chainiksolvervel_wdls.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <random>

#include "kernels/geometry.hpp"
#include "platform/tools/programming/kinematic_chain.hpp"

namespace glint {

struct SolverSettings {
  double position_tolerance_m = 1e-4;
  double rotation_tolerance_rad = 1e-3;
  int iterations_max = 100;  // of one solution
};

struct JointSolution {
  KDL::JntArray joints;
  bool converged = false;     // what follows is valid
  int beyond_joint = -1;      // joint farthest beyond its limits; -1: none
  double beyond = 0;          // radians or metres
  double singular_value = 0;  // smallest of the Jacobian, lengths in units of the chain's reach
};

class InverseKinematics {
 public:
  // Keeps a reference to the chain.
  InverseKinematics(const KinematicChain& chain, const SolverSettings& settings);
  InverseKinematics(const InverseKinematics&) = delete;
  InverseKinematics& operator=(const InverseKinematics&) = delete;

  // The solution that the guess leads to. Revolute joints are moved by whole
  // turns next to the guess and into their limits.
  [[nodiscard]] JointSolution solve(const Pose& pose, const KDL::JntArray& guess);
  // Uniform within the limits; within a turn for continuous joints.
  [[nodiscard]] KDL::JntArray random_guess(std::mt19937& random) const;

 private:
  void fit_limits(const KDL::JntArray& guess, JointSolution& out) const;
  [[nodiscard]] double smallest_singular_value(const KDL::JntArray& joints);

  const KinematicChain& chain_;
  SolverSettings settings_;
  KDL::ChainFkSolverPos_recursive forward_;
  KDL::ChainIkSolverVel_wdls step_;
  KDL::ChainIkSolverPos_NR inverse_;
  KDL::ChainJntToJacSolver jacobian_;
};

}  // namespace glint
