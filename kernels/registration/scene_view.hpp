// Input of an alignment: one depth image of the scene, and the model at its joint positions.
#pragma once

#include <cstdint>
#include <span>

#include "kernels/registration/model_cloud.hpp"
#include "kernels/registration/triangle.hpp"

namespace glint {

inline constexpr int k_scene_views_max = 16;
// Of a view's image. Depth of 1280 x 720 is reduced by four: adjacent pixels are then a few
// millimetres apart at arm's length, about the accuracy of depth.
inline constexpr int k_scene_pixels_max = 1 << 17;
inline constexpr int k_scene_corners_max = 1 << 23;  // of a view's model

// All borrowed.
struct SceneView {
  Pinhole camera;
  std::span<const float> depth_m;      // z of each pixel, 0 where there is none
  std::span<const std::uint8_t> mask;  // 0: not the model; empty: unknown
  Surface model;                       // in the base's frame, at this view's joint positions
  Pose T_camera_world;                 // identity for a static camera
  ModelCloud cloud{};                  // replaces the triangles of `model` if it has points

  [[nodiscard]] bool may_be_model(std::size_t pixel) const {
    return mask.empty() || mask[pixel] != 0;
  }
};

[[nodiscard]] inline Vector3f pixel_point(const Pinhole& camera, int x, int y, float z_m) {
  return {static_cast<float>((x + 0.5 - camera.cx) / camera.fx) * z_m,
          static_cast<float>((y + 0.5 - camera.cy) / camera.fy) * z_m, z_m};
}

}  // namespace glint
