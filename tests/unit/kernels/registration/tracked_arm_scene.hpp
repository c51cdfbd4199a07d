// Test scene: an arm of boxes in front of a wall, and a tracker of its reference pose.
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "kernels/registration/follow_reference.hpp"
#include "tests/unit/kernels/registration/box_model.hpp"

namespace glint::test {

inline constexpr int k_world_pixels = 160 * 120;

inline Time at(double seconds) { return {static_cast<std::int64_t>(seconds * 1e9)}; }

struct TrackedArmScene {
  BoxArm model;
  Pinhole camera{160, 120, 150, 150, 80, 60};
  std::vector<float> depth = std::vector<float>(k_world_pixels);
  std::mt19937 random{3};
  RobotPoseTracker follower;

  TrackedArmScene() {
    EXPECT_EQ(follower.prepare(k_world_pixels, 64), Reason::none);
    Matrix6 covariance = Matrix6::Zero();
    covariance.diagonal() << 1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6;
    follower.begin(k_truth, covariance, at(0));
  }
  [[nodiscard]] SceneView view() const {
    return {camera, depth, {}, {model.corners, model.faces}, {}};
  }
  // With 1 % depth noise, and a wall behind.
  void draw(const Pose& truth) {
    std::vector<std::int32_t> face(depth.size());
    std::vector<ProjectedCorner> corners(64);
    EXPECT_EQ(render_depth({model.corners, model.faces}, truth, camera, {depth, face, corners}),
              Reason::none);
    std::normal_distribution<float> noise(0, 0.01f);
    for (float& z : depth) z = z == 0 ? 1.9f : z * (1 + noise(random));
  }
  // Returns the number of slices.
  int look(Time time) {
    int slices = 0;
    if (!follower.look(view(), time)) return slices;
    do {
      ++slices;
    } while (follower.step());
    return slices;
  }
};

}  // namespace glint::test
