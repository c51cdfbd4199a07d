// The memory of an alignment: rendered pictures, points seen, grids.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/nonblocking.hpp"
#include "kernels/pose/pose_factor.hpp"
#include "kernels/registration/point_grid.hpp"
#include "kernels/registration/seen_points.hpp"
#include "kernels/registration/splat_cloud.hpp"

namespace glint {

class AlignmentScratch {
 public:
  // Allocates, for so many views of so many pixels, and corners or points of a model, each.
  // Reason::out_of_range: none or too many.
  [[nodiscard]] Reason prepare(int views, int pixels, int corners);

  struct View {
    std::vector<float> z;
    std::vector<std::int32_t> triangle;
    std::vector<ProjectedCorner> corners;
    std::vector<SeenPoint> seen;
    std::vector<Vector3f> scene;
    std::vector<Vector6> patches;  // of patch_covariance.hpp: no more than a 16th of the pixels
    PointGrid grid;                // of the scene
    int seen_count = 0;
  };
  std::vector<View> views;
};

// Whether the scratch is large enough, and each view as large as its camera says.
[[nodiscard]] bool scene_fits(std::span<const SceneView> views,
                              const AlignmentScratch& scratch) noexcept GLINT_NONBLOCKING;

// What is seen of the model, every step-th pixel of every step-th row.
void render_model(const SceneView& view, const Pose& T_world_base, int step,
                  AlignmentScratch::View& memory) noexcept GLINT_NONBLOCKING;

// The same in slices, step by step until true. A model of triangles is rendered at once.
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

// Makes the scene's points, every step-th, ready for searches within reach_m.
void search_scene(const SceneView& view, int step, double reach_m,
                  AlignmentScratch::View& memory) noexcept GLINT_NONBLOCKING;

// The same of all pixels, in slices.
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
