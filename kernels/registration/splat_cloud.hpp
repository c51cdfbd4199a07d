// Renders a point cloud model into a z-buffer by splatting: one disc per point; returns the visible
// points.
//
// What:     each point is a disc perpendicular to its normal with a radius of k_disc_radius
//           spacings, so that the discs leave no hole. A pixel keeps the disc nearest to the
//           camera; of discs of one surface, no farther apart in depth than the spacing, the one
//           whose centre is nearest to the pixel. A point is visible where a pixel's ray meets its
//           disc within k_visible_radius spacings of the centre: farther out a disc may extend
//           beyond the model's edge.
// Cost:     a transformation a point, and a ray-plane intersection for each pixel around it.
// Worst:    a model near the camera: k_splat_reach pixels on each side; stops after
//           k_splat_tests_per_pixel tests a pixel of the image (Reason::search_full).
// Accuracy: exact at the pixel's centre on a flat surface; on a curved one the disc's height above
//           it: 0.1 mm for 4 mm of spacing and a radius of 50 mm. Edges: k_visible_radius spacings.
// Source:   visibility splatting, Zwicker et al. 2001, section 3; Botsch and Kobbelt 2003.
#pragma once

#include <span>

#include "kernels/registration/visible_points.hpp"
#include "kernels/slice_size.hpp"

namespace glint {

inline constexpr float k_disc_radius = 1.5f;
inline constexpr float k_visible_radius = 0.75f;
inline constexpr int k_splat_reach = 6;
// 60,000 points at 1.2 m take 20 in an image of 320 x 288.
inline constexpr int k_splat_tests_per_pixel = 256;

// Pixels cleared per step; steps per point, per pixel tested; per pixel of the raster, per visible
// pixel.
inline constexpr int k_splat_cleared_per_step = 2, k_splat_point_steps = 40,
                     k_splat_test_steps = 10, k_splat_pixel_steps = 4, k_splat_visible_steps = 40;
inline constexpr int k_splat_item_steps_max =
    k_splat_point_steps + (2 * k_splat_reach + 1) * (2 * k_splat_reach + 1) * k_splat_test_steps;

// Rendering and visible points in slices that exceed the budget's steps by at most one point's.
class CloudSplat {
 public:
  // Reason::out_of_range as splat_cloud(); step() then returns true at once, without points.
  [[nodiscard]] Reason start(const ModelCloud& model, const Pose& T_camera_model,
                             const Pinhole& camera, int raster, const DepthBuffer& buffer,
                             std::span<VisiblePoint> points) noexcept GLINT_NONBLOCKING;
  // Returns true when rendering is complete and the visible points are written.
  [[nodiscard]] bool step(StepBudget& budget) noexcept GLINT_NONBLOCKING;

  [[nodiscard]] int count() const noexcept { return static_cast<int>(count_); }
  [[nodiscard]] Reason reason() const noexcept { return reason_; }

 private:
  enum class Phase : std::uint8_t { clear, splat, gather, done };
  void splat_points(StepBudget& budget) noexcept;
  void gather_points(StepBudget& budget) noexcept;

  ModelCloud model_;
  Pose T_camera_model_;
  Pinhole camera_;
  DepthBuffer buffer_;
  std::span<VisiblePoint> points_;
  Phase phase_ = Phase::done;
  Reason reason_ = Reason::none;
  int raster_ = 1, at_ = 0;
  std::int64_t tests_left_ = 0;
  std::size_t count_ = 0;
};

// As render_depth(), with a point's index in place of a triangle's. Reason::out_of_range: the
// buffer does not have the camera's size or has fewer corners than the cloud has points; or the
// numbers of normals and points differ.
[[nodiscard]] Reason splat_cloud(const ModelCloud& model, const Pose& T_camera_model,
                                 const Pinhole& camera,
                                 const DepthBuffer& buffer) noexcept GLINT_NONBLOCKING;

// As visible_points(), for the view's cloud.
[[nodiscard]] int visible_cloud_points(const SceneView& view, const Pose& T_camera_base, int step,
                                       const DepthBuffer& buffer,
                                       std::span<VisiblePoint> points) noexcept GLINT_NONBLOCKING;

}  // namespace glint
