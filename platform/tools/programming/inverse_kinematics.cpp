#include "platform/tools/programming/inverse_kinematics.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint {
namespace {

constexpr double k_turn = 2 * std::numbers::pi;
constexpr double k_solver_error = 1e-8;     // m, rad; far below the tolerances
constexpr double k_limit_tolerance = 1e-6;  // rad, m; a point at the limit is valid
// Steps are damped where the Jacobian's smallest singular value is below k_damped_below.
constexpr double k_damping = 0.05, k_damped_below = 0.05;

}  // namespace

InverseKinematics::InverseKinematics(const KinematicChain& chain, const SolverSettings& settings)
    : chain_(chain),
      settings_(settings),
      forward_(chain.chain),
      step_(chain.chain),
      inverse_(chain.chain, forward_, step_, static_cast<unsigned>(settings.iterations_max),
               k_solver_error),
      jacobian_(chain.chain) {
  step_.setLambda(k_damping);
  step_.setEps(k_damped_below);
}

JointSolution InverseKinematics::solve(const Pose& pose, const KDL::JntArray& guess) {
  const Quaternion q = pose.rotation.normalized();
  const Vector3& t = pose.translation;
  const KDL::Frame goal(KDL::Rotation::Quaternion(q.x(), q.y(), q.z(), q.w()),
                        KDL::Vector(t.x(), t.y(), t.z()));
  JointSolution out{guess};
  // The error below decides instead of the return code: at the border of the workspace the solver
  // converges slowly.
  (void)inverse_.CartToJnt(guess, goal, out.joints);
  KDL::Frame reached;
  if (!out.joints.data.allFinite() || forward_.JntToCart(out.joints, reached) < 0) return out;
  const KDL::Twist error = KDL::diff(reached, goal);
  out.converged = error.vel.Norm() <= settings_.position_tolerance_m &&
                  error.rot.Norm() <= settings_.rotation_tolerance_rad;
  if (!out.converged) return out;
  fit_limits(guess, out);
  out.singular_value = smallest_singular_value(out.joints);
  return out;
}

KDL::JntArray InverseKinematics::random_guess(std::mt19937& random) const {
  KDL::JntArray guess(static_cast<unsigned>(chain_.joints.size()));
  for (std::size_t i = 0; i < chain_.joints.size(); ++i) {
    const bool finite = std::isfinite(chain_.lower[i]) && std::isfinite(chain_.upper[i]);
    const double low = finite ? chain_.lower[i] : -std::numbers::pi;
    const double high = finite ? chain_.upper[i] : std::numbers::pi;
    guess(static_cast<unsigned>(i)) = low + (high - low) * (random() * 0x1p-32);
  }
  return guess;
}

void InverseKinematics::fit_limits(const KDL::JntArray& guess, JointSolution& out) const {
  for (std::size_t i = 0; i < chain_.joints.size(); ++i) {
    double& value = out.joints(static_cast<unsigned>(i));
    const double low = chain_.lower[i], high = chain_.upper[i];
    if (chain_.revolute[i]) {
      value += k_turn * std::round((guess(static_cast<unsigned>(i)) - value) / k_turn);
      if (value < low) value += k_turn * std::ceil((low - value) / k_turn);
      if (value > high) value -= k_turn * std::ceil((value - high) / k_turn);
      // No whole turn leads into the limits: the one that is nearest to them.
      if (value < low) value += k_turn * std::round((0.5 * (low + high) - value) / k_turn);
    }
    const double beyond = std::max(low - value, value - high);
    if (beyond > std::max(out.beyond, k_limit_tolerance)) {
      out.beyond = beyond;
      out.beyond_joint = static_cast<int>(i);
    }
  }
}

double InverseKinematics::smallest_singular_value(const KDL::JntArray& joints) {
  KDL::Jacobian j(static_cast<unsigned>(chain_.joints.size()));
  if (jacobian_.JntToJac(joints, j) < 0) return 0;
  Eigen::MatrixXd scaled = j.data;
  scaled.topRows(3) /= std::max(chain_.reach_m, 1e-6);
  return Eigen::JacobiSVD<Eigen::MatrixXd>(scaled).singularValues().minCoeff();
}

}  // namespace glint
