// Strokes that a six-axis arm can draw, and points that it cannot reach, judged by its closed form.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "platform/tools/programming/reach_check.hpp"
#include "tests/unit/kernels/pose/scene.hpp"
#include "tests/unit/platform/tools/programming/six_axis_arm.hpp"
#include "tests/unit/platform/tools/robot/files.hpp"

namespace glint::test::arm_strokes {

using Arm = SixAxisArm;
using Joints = Arm::Joints;

inline UncertainPose point_at(const Pose& pose) {
  return {Time{}, pose, Matrix6::Identity() * 1e-8};
}

// Joint paths of 10 to 25 points within the limits and away from singularities.
inline PathElement stroke_of(const Arm& arm, Random& random) {
  constexpr double k_margin = 0.15;
  for (;;) {
    Joints q{}, rate{};
    for (std::size_t i = 0; i < 6; ++i) {
      q[i] = random.within(arm.low[i] + k_margin, arm.high[i] - k_margin);
      rate[i] = random.within(-0.03, 0.03);
    }
    PathElement stroke{PathKind::stroke, {}};
    const int points = 10 + random.below(16);
    for (int n = 0; n < points; ++n) {
      if (!arm.within(q, k_margin) || Arm::from_singular(q) < 0.25) break;
      stroke.points.push_back(point_at(Arm::forward(q)));
      for (std::size_t i = 0; i < 6; ++i) q[i] += rate[i];
    }
    if (static_cast<int>(stroke.points.size()) == points) return stroke;
  }
}

inline DrawnPath strokes_of(const Arm& arm, std::uint64_t random_seed) {
  Random random(random_seed);
  DrawnPath path;
  while (path.size() < 30) path.push_back(stroke_of(arm, random));
  return path;
}

// What the closed form finds: the fault of every configuration, or none if one is valid.
inline std::optional<ReachFault> truth(const Arm& arm, const Pose& pose) {
  const std::vector<Joints> all = Arm::inverse(pose);
  if (all.empty()) return ReachFault::unreachable;
  bool within = false;
  for (const Joints& q : all) {
    if (!arm.within(q, 0)) continue;
    within = true;
    if (Arm::from_singular(q) > 1e-3) return {};
  }
  return within ? ReachFault::singular : ReachFault::joint_limit;
}

inline Pose unreachable_pose(Random& random) {
  const Vector3 away = random.vector(1).normalized();
  return {random.rotation(), Vector3(0, 0, Arm::base) + random.within(1.0, 3.0) * away};
}

// Every configuration beyond the limits by 0.1 rad or more, and none singular.
inline Pose limited_pose(const Arm& arm, Random& random) {
  Arm wider = arm;
  for (std::size_t i = 0; i < 6; ++i) {
    wider.low[i] -= 0.1;
    wider.high[i] += 0.1;
  }
  for (;;) {
    Joints q{};
    for (double& one : q) one = random.within(-3.1, 3.1);
    const Pose pose = Arm::forward(q);
    bool fits = Arm::from_singular(q) > 0.25;
    for (const Joints& other : Arm::inverse(pose)) fits = fits && !wider.within(other, 0);
    if (fits) return pose;
  }
}

// Elbow straight (the arm's border), wrist straight in the only configuration within the limits, or
// wrist centre above the base.
inline Pose singular_pose(const Arm& arm, Random& random, int kind) {
  for (;;) {
    Joints q{};
    for (std::size_t i = 0; i < 6; ++i) q[i] = random.within(arm.low[i], arm.high[i]);
    if (kind == 0) q[4] = 0;
    if (kind == 1)
      q[1] = -std::atan2(Arm::fore * std::sin(q[2]), Arm::upper + Arm::fore * std::cos(q[2]));
    const Pose pose = Arm::forward(q);
    if (truth(arm, pose) == ReachFault::singular && arm.within(q, 0.05)) return pose;
  }
}

struct Robot {
  explicit Robot(const Arm& arm, const std::string& shapes = "")
      : urdf(files.write("arm.urdf", arm.urdf(shapes))), chain(read_chain(urdf, "tip")) {}
  Files files;
  std::string urdf;
  KinematicChain chain;
};

}  // namespace glint::test::arm_strokes
