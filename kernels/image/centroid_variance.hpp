// Variance of a grown centroid, each axis separately.
//
// What:     the first moment's variance by pixel noise and by noise of the subtracted background;
//           sampling error of a sharp rim by pixels of finite size, larger if saturation clips the
//           rim; possible light of a neighbour. shape_variance: possible offset of the centre if
//           the blob is cut, merged or partially occluded. surface_variance: offset by an uneven
//           background.
// Cost:     some eighty operations, a root and no loop.
// Worst:    data independent.
// Accuracy: spheres of 4 to 10 px, static and with 2 px of motion blur, three and ten times
//           saturated, of 70 counts at 2 % noise: rms error / stated sigma 0.7 to 1.4 (`glint
//           experiment centroid`). At slight saturation it is up to eight times too large, because
//           the light does not show by how much it is clipped. For a blob that is no complete disc
//           it is an upper estimate.
// Source:   noise propagation through a ratio of sums; the rim's part is derived in
//           centroid_variance.cpp.
#pragma once

#include <array>

#include "kernels/image/blob_scratch.hpp"
#include "kernels/image/blob_settings.hpp"
#include "kernels/image/centroid.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

// Variances of x and y, px^2. Requires the settings of the blob's detection.
[[nodiscard]] std::array<float, 2> centroid_variance(
    const Centroid& centroid, const Component& component,
    const BlobSettings& settings) noexcept GLINT_NONBLOCKING;

// Limits of the excess (longer minus shorter side) of a complete disc's box, in pixels and relative
// to the shorter side. A disc with two pixels of motion blur stays below.
inline constexpr int k_excess_min_px = 3;
inline constexpr double k_excess_min_ratio = 0.75;
// Standard deviation of a centroid whose blob the frame's border cuts, even if its box is square.
inline constexpr float k_border_sigma_px = 1;

[[nodiscard]] constexpr int excess_px(const Component& component) {
  const int width = component.x1 - component.x0, height = component.y1 - component.y0;
  return width > height ? width - height : height - width;
}
[[nodiscard]] constexpr bool is_partial_or_merged(const Component& component) {
  const int width = component.x1 - component.x0, height = component.y1 - component.y0;
  const int shorter = width < height ? width : height;
  return excess_px(component) >= k_excess_min_px &&
         excess_px(component) > k_excess_min_ratio * shorter;
}

// Variance to add if the border cuts the blob or is_partial_or_merged(): the centres of two merged
// discs, or the centre of a half occluded one, are half the excess away.
[[nodiscard]] std::array<float, 2> shape_variance(const Component& component, bool cut_x,
                                                  bool cut_y) noexcept GLINT_NONBLOCKING;

// Variance to add for a component of rescan_oversized(): its background is a surface, which may end
// beside the marker. Square of the offset by a step between the backgrounds on opposite sides.
[[nodiscard]] std::array<float, 2> surface_variance(const Frame& frame, const Centroid& centroid,
                                                    const Component& component) noexcept
    GLINT_NONBLOCKING;

}  // namespace glint
