#include "platform/tools/programming/path_motion.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/motion/interpolate.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr double k_steps_max = 10'000;      // of one move
constexpr double k_same_joints_max = 0.01;  // rad or m: far above the tolerances of a solution

// Joint positions between two points, without both; empty if the move cannot be followed.
std::optional<std::vector<KDL::JntArray>> between(const Pose& from, const KDL::JntArray& begin,
                                                  const Pose& to, const KDL::JntArray& end,
                                                  InverseKinematics& solver,
                                                  const MotionSteps& steps) {
  const int count =
      step_count((to.translation - from.translation).norm(),
                 rotation_vector(from.rotation.conjugate() * to.rotation).norm(), steps);
  std::vector<KDL::JntArray> joints{begin};
  for (int i = 1; i <= count; ++i) {
    const double share = static_cast<double>(i) / count;
    const JointSolution next =
        solver.solve({slerp(from.rotation, to.rotation, share),
                      constant_velocity(from.translation, to.translation, share)},
                     joints.back());
    if (!next.converged || next.beyond_joint >= 0) return {};
    joints.push_back(next.joints);
  }
  if ((joints.back().data - end.data).cwiseAbs().maxCoeff() > k_same_joints_max) return {};
  return std::vector<KDL::JntArray>(joints.begin() + 1, joints.end() - 1);
}

}  // namespace

int step_count(double distance_m, double rotation_rad, const MotionSteps& steps) {
  const double count =
      std::ceil(std::max({distance_m / steps.distance_m, rotation_rad / steps.rotation_rad, 1.0}));
  if (!(count <= k_steps_max)) {
    throw InputError("path: a move of " + std::to_string(distance_m) + " m has more than " +
                     std::to_string(static_cast<int>(k_steps_max)) +
                     " steps; expected a larger --collision-step");
  }
  return static_cast<int>(count);
}

PathMotion path_motion(const DrawnPath& path, const FollowedPath& followed,
                       const KinematicChain& chain, const PathCheckSettings& settings,
                       const MotionSteps& steps) {
  InverseKinematics solver(chain, settings.solver);
  PathMotion motion;
  const Pose* before = nullptr;  // of the point before, if it has joint positions
  const KDL::JntArray* begin = nullptr;
  for (std::size_t e = 0; e < path.size(); ++e) {
    for (std::size_t p = 0; p < path[e].points.size(); ++p) {
      const Pose& pose = path[e].points[p].pose;
      const auto& joints = followed.joints[e][p];
      if (joints && before != nullptr) {
        ++motion.moves;
        const auto moved = between(*before, *begin, pose, *joints, solver, steps);
        if (!moved) ++motion.not_followed;
        for (const KDL::JntArray& step : moved.value_or(std::vector<KDL::JntArray>{}))
          motion.samples.push_back({e + 1, p + 1, false, step});
      }
      if (joints) motion.samples.push_back({e + 1, p + 1, true, *joints});
      before = joints ? &pose : nullptr;
      begin = joints ? &*joints : nullptr;
    }
  }
  return motion;
}

}  // namespace glint
