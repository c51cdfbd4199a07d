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

namespace glint {

inline constexpr float k_disc_radius = 1.5f;
inline constexpr float k_seen_radius = 0.75f;
inline constexpr int k_splat_reach = 6;
// 60,000 points at 1.2 m take 20 of a picture of 320 x 288.
inline constexpr int k_splat_tests_a_pixel = 256;

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
