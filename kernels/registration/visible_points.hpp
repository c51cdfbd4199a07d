// Visible points of a model at a pose: one point with normal per rendered pixel.
//
// What:     for each rendered pixel of a raster its point, and its triangle's normal towards the
//           camera, in the camera frame.
// Cost:     one rendering, and a cross product and a root for each pixel taken.
// Worst:    the model fills the image: one point for every pixel of the raster.
// Accuracy: that of render_depth.hpp.
// Source:   hidden points must not enter the fit: the far side of a whole model would be paired
//           with the near side of the scene.
#pragma once

#include <span>

#include "kernels/nonblocking.hpp"
#include "kernels/registration/render_depth.hpp"
#include "kernels/registration/scene_view.hpp"

namespace glint {

struct VisiblePoint {
  Vector3f point, normal;
  std::int32_t pixel = 0;
};

// Takes every step-th pixel of every step-th row. Returns the number of points written: at most
// points.size().
[[nodiscard]] int visible_points(const SceneView& view, const Pose& T_camera_base, int step,
                                 const DepthBuffer& buffer,
                                 std::span<VisiblePoint> points) noexcept GLINT_NONBLOCKING;

}  // namespace glint
