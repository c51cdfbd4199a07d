// Preallocated memory of an alignment: rendered images, visible points, search grids.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/nonblocking.hpp"
#include "kernels/pose/pose_factor.hpp"
#include "kernels/registration/point_grid.hpp"
#include "kernels/registration/splat_cloud.hpp"
#include "kernels/registration/visible_points.hpp"

namespace glint {

class AlignmentScratch {
 public:
  // Allocates memory for `views` views, each with `pixels` pixels and a model of `corners` corners
  // or points. Reason::out_of_range: a size below 1 or above its maximum.
  [[nodiscard]] Reason prepare(int views, int pixels, int corners);

  struct View {
    std::vector<float> z;
    std::vector<std::int32_t> triangle;
    std::vector<ProjectedCorner> corners;
    std::vector<VisiblePoint> seen;
    std::vector<Vector3f> scene;
    std::vector<Vector6> patches;  // of patch_covariance.hpp: at most 1/16 of the pixels
    PointGrid grid;                // of the scene
    int visible_count = 0;
  };
  std::vector<View> views;
};

// Returns true if the scratch is large enough and each view's data has its camera's size.
[[nodiscard]] bool scene_fits(std::span<const SceneView> views,
                              const AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;

// Visible points of the model at every step-th pixel of every step-th row.
void render_model(const SceneView& view, const Pose& T_world_base, int step,
                  AlignmentScratch::View& memory) noexcept GLINT_NONBLOCKING;

// The same in slices: call step() until it returns true. A triangle model is rendered in one slice.
class ModelRendering {
 public:
  void start(const SceneView& view, const Pose& T_world_base, int step,
             AlignmentScratch::View& memory) noexcept GLINT_NONBLOCKING;
  [[nodiscard]] bool step(StepBudget& budget,
                          AlignmentScratch::View& memory) noexcept GLINT_NONBLOCKING;

 private:
  CloudSplat splat_;
  bool of_points_ = false;
};

// Builds the search grid of the scene's points, every step-th pixel in both directions, for
// searches within reach_m.
void index_scene(const SceneView& view, int step, double reach_m,
                 AlignmentScratch::View& memory) noexcept GLINT_NONBLOCKING;

// The same for all pixels, in slices.
inline constexpr int k_scene_pixel_steps = 16;
class SceneIndexing {
 public:
  void start() noexcept GLINT_NONBLOCKING;
  [[nodiscard]] bool step(const SceneView& view, double reach_m, StepBudget& budget,
                          AlignmentScratch::View& memory) noexcept GLINT_NONBLOCKING;

 private:
  int at_ = 0;
  std::size_t count_ = 0;
  bool building_ = false;
};

}  // namespace glint
