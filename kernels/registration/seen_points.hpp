// The points of a model that a camera sees at a pose: a rendered pixel each.
//
// What:     for each rendered pixel of a raster its point and its triangle's normal, towards the
//           camera, in the camera's frame.
// Cost:     one rendering, and a cross product and a root for each pixel taken.
// Worst:    the model fills the picture: a point for every pixel of the raster.
// Accuracy: that of render_depth.hpp.
// Source:   what is hidden must not pull: the far side of a whole model is drawn to the near side
//           of the scene.
#pragma once

#include <span>

#include "kernels/nonblocking.hpp"
#include "kernels/registration/render_depth.hpp"
#include "kernels/registration/scene_view.hpp"

namespace glint {

struct SeenPoint {
  Vector3f point, normal;
  std::int32_t pixel = 0;
};

// step: every such pixel of every such row. Returns how many were written: at most points.size().
[[nodiscard]] int seen_points(const SceneView& view, const Pose& T_camera_base, int step,
                              const DepthBuffer& buffer,
                              std::span<SeenPoint> points) noexcept GLINT_NONBLOCKING;

}  // namespace glint
