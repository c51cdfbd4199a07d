// A model as points with normals: what a board has of a robot, which reads no meshes.
//
// What:     points that stand for the links' surfaces, and where they are when the links stand at
//           their poses.
// Cost:     two rotations a point, and a rotation made of a quaternion where the link is another
//           than the last point's. All at once or in slices (slice_size.hpp): the same bits.
// Worst:    points that lie on other links in turn.
// Accuracy: float's rounding.
// Source:   surfels: Pfister et al. 2000, section 3.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "kernels/nonblocking.hpp"
#include "kernels/reason.hpp"
#include "kernels/registration/triangle.hpp"
#include "kernels/robot/forward_kinematics.hpp"
#include "kernels/slice_size.hpp"

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

// Of a point, and of another link than the last point's.
inline constexpr int k_posed_point_steps = 16, k_posed_link_steps = 16;
inline constexpr int k_posed_item_steps_max = k_posed_point_steps + k_posed_link_steps;

// The cloud in the root's frame, in slices of at most the budget's steps and those of one point
// beyond it. What it is given must stay until step() says false.
class PoseCloudRun {
 public:
  // Reason::out_of_range: spans of different sizes, or too many points; there is nothing to do.
  [[nodiscard]] Reason start(const LinkCloud& robot, const LinkPoses& poses,
                             std::span<Vector3f> points,
                             std::span<Vector3f> normals) noexcept GLINT_NONBLOCKING;
  // True while there is more.
  [[nodiscard]] bool step(StepBudget& budget) noexcept GLINT_NONBLOCKING;
  // Also Reason::out_of_range: ended at a link that has no pose; what was written until then
  // stands.
  [[nodiscard]] Reason reason() const noexcept { return reason_; }

 private:
  void turn_to(int link) noexcept;

  LinkCloud robot_;
  const LinkPoses* poses_ = nullptr;
  std::span<Vector3f> points_, normals_;
  Eigen::Matrix3f rotation_ = Eigen::Matrix3f::Identity();  // of the link
  Vector3f translation_ = Vector3f::Zero();
  int link_ = -1;       // of the last point
  std::size_t at_ = 0;  // of the points
  Reason reason_ = Reason::none;
};

// All slices at once; what start() or reason() says.
[[nodiscard]] Reason pose_cloud(const LinkCloud& robot, const LinkPoses& poses,
                                std::span<Vector3f> points,
                                std::span<Vector3f> normals) noexcept GLINT_NONBLOCKING;

}  // namespace glint
