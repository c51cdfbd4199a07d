// A model as points with normals: what a board has of a robot, which reads no meshes.
//
// What:     points that stand for the links' surfaces, and where they are when the links stand at
//           their poses.
// Cost:     two rotations a point.
// Worst:    none is worse than another.
// Accuracy: float's rounding.
// Source:   surfels: Pfister et al. 2000, section 3.
#pragma once

#include <cstdint>
#include <span>

#include "kernels/nonblocking.hpp"
#include "kernels/reason.hpp"
#include "kernels/registration/triangle.hpp"
#include "kernels/robot/forward_kinematics.hpp"

namespace glint {

inline constexpr int k_model_points_max = 1 << 20;

// Borrowed. Normals are of unit length and may point to either side.
struct ModelCloud {
  std::span<const Vector3f> points, normals;  // metres; as many of one as of the other
  float spacing_m = 0;  // the side of the square of surface that a point stands for
};

// Each point in the frame of its link. Borrowed.
struct LinkCloud {
  ModelCloud cloud;
  std::span<const std::uint16_t> links;
};

// The cloud in the root's frame. Reason::out_of_range: spans of different sizes, or a link that has
// no pose; what was written until then stands.
[[nodiscard]] Reason pose_cloud(const LinkCloud& robot, const LinkPoses& poses,
                                std::span<Vector3f> points,
                                std::span<Vector3f> normals) noexcept GLINT_NONBLOCKING;

}  // namespace glint
