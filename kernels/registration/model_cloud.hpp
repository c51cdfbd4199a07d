// Robot model as a point cloud with normals (surfels), posed by its links. A companion computer
// uses it in place of meshes, which it does not read.
//
// What:     points that represent the links' surfaces, transformed by the links' poses.
// Cost:     two rotations a point, and one rotation matrix where the link differs from the last
//           point's. All at once or in slices (slice_size.hpp): the same bits.
// Worst:    consecutive points on different links.
// Accuracy: float rounding.
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

// Borrowed. Normals have unit length and either sign.
struct ModelCloud {
  std::span<const Vector3f> points, normals;  // metres; equal in number
  float spacing_m = 0;  // side of the square of surface that a point represents
};

// Each point in the frame of its link. Borrowed.
struct LinkCloud {
  ModelCloud cloud;
  std::span<const std::uint16_t> links;
};

// Steps per point; per change of link.
inline constexpr int k_posed_point_steps = 16, k_posed_link_steps = 16;
inline constexpr int k_posed_item_steps_max = k_posed_point_steps + k_posed_link_steps;

// Transforms the cloud to the root's frame, in slices that exceed the budget's steps by at most one
// point's. The arguments of start() must not change until step() returns false.
class PoseCloudRun {
 public:
  // Reason::out_of_range: spans of different sizes, or too many points; step() then has no work.
  [[nodiscard]] Reason start(const LinkCloud& robot, const LinkPoses& poses,
                             std::span<Vector3f> points,
                             std::span<Vector3f> normals) noexcept GLINT_NONBLOCKING;
  // Returns true while there is more.
  [[nodiscard]] bool step(StepBudget& budget) noexcept GLINT_NONBLOCKING;
  // Also Reason::out_of_range: stopped at a link without a pose; the points written before remain.
  [[nodiscard]] Reason reason() const noexcept { return reason_; }

 private:
  void select_link(int link) noexcept;

  LinkCloud robot_;
  const LinkPoses* poses_ = nullptr;
  std::span<Vector3f> points_, normals_;
  Eigen::Matrix3f rotation_ = Eigen::Matrix3f::Identity();  // of the link
  Vector3f translation_ = Vector3f::Zero();
  int link_ = -1;       // of the last point
  std::size_t at_ = 0;  // of the points
  Reason reason_ = Reason::none;
};

// Runs all slices; returns the reason of start() or reason().
[[nodiscard]] Reason pose_cloud(const LinkCloud& robot, const LinkPoses& poses,
                                std::span<Vector3f> points,
                                std::span<Vector3f> normals) noexcept GLINT_NONBLOCKING;

}  // namespace glint
