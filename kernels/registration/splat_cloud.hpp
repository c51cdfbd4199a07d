// What a camera could see of a model that is points: discs in a z-buffer.
//
// What:     each point is a disc across its normal, k_disc_radius of the cloud's spacing wide, so
//           that discs leave no hole. A pixel keeps the disc that is nearest to the camera; of
//           discs of one surface, not farther apart in depth than the spacing, the one whose middle
//           is nearest to the pixel. Seen is what a pixel's ray meets within k_seen_radius of
//           its disc's middle: beyond, a disc may stick out of the model's edge.
// Cost:     a transformation a point, and a plane met by a ray for each pixel about it.
// Worst:    a model near the camera: k_splat_reach pixels on each side; ended after
//           k_splat_tests_a_pixel tests a pixel of the picture (Reason::search_full).
// Accuracy: on a flat surface exact at the pixel's middle; on a curved one the disc's height over
//           it: 0.1 mm for 4 mm of spacing and a radius of 50 mm. Edges: k_seen_radius spacings.
// Source:   visibility splatting, Zwicker et al. 2001, section 3; Botsch and Kobbelt 2003.
#pragma once

#include <span>

#include "kernels/registration/seen_points.hpp"
#include "kernels/slice_size.hpp"

namespace glint {

inline constexpr float k_disc_radius = 1.5f;
inline constexpr float k_seen_radius = 0.75f;
inline constexpr int k_splat_reach = 6;
// 60,000 points at 1.2 m take 20 of a picture of 320 x 288.
inline constexpr int k_splat_tests_a_pixel = 256;

// Of pixels cleared, of a point, of each pixel that it is tested at; of a pixel of the raster and
// of one that is seen.
inline constexpr int k_splat_cleared_a_step = 2, k_splat_point_steps = 40, k_splat_test_steps = 10,
                     k_splat_pixel_steps = 4, k_splat_seen_steps = 40;
inline constexpr int k_splat_item_steps_max =
    k_splat_point_steps + (2 * k_splat_reach + 1) * (2 * k_splat_reach + 1) * k_splat_test_steps;

// Both in slices of at most the budget's steps and those of one point beyond it.
class CloudSplat {
 public:
  // Reason::out_of_range as splat_cloud() gives it; step() then says true at once, of no points.
  [[nodiscard]] Reason start(const ModelCloud& model, const Pose& T_camera_model,
                             const Pinhole& camera, int raster, const DepthBuffer& buffer,
                             std::span<SeenPoint> points) noexcept GLINT_NONBLOCKING;
  // True when all is rendered and the points that are seen are there.
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
  std::span<SeenPoint> points_;
  Phase phase_ = Phase::done;
  Reason reason_ = Reason::none;
  int raster_ = 1, at_ = 0;
  std::int64_t tests_left_ = 0;
  std::size_t count_ = 0;
};

// As render_depth(), with a point's number where a triangle's was. Reason::out_of_range: the buffer
// does not have the camera's size, or fewer corners than the cloud has points; or normals
// are not as many as points.
[[nodiscard]] Reason splat_cloud(const ModelCloud& model, const Pose& T_camera_model,
                                 const Pinhole& camera,
                                 const DepthBuffer& buffer) noexcept GLINT_NONBLOCKING;

// As seen_points(), of the view's cloud.
[[nodiscard]] int seen_cloud_points(const SceneView& view, const Pose& T_camera_base, int step,
                                    const DepthBuffer& buffer,
                                    std::span<SeenPoint> points) noexcept GLINT_NONBLOCKING;

}  // namespace glint
