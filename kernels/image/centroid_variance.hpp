// How far a grown centroid may be off, each axis for itself.
//
// What:     the first moment's variance under the pixels' noise, and that of the background taken
//           off; what pixels of finite size do to a sharp rim, and more so to one clipped by
//           saturation; what a neighbour's light may do. shape_variance: what a box may hide that
//           is no whole disc's, as its blob is cut, merged or half covered.
// Cost:     some eighty operations, a root and no loop.
// Worst:    none is worse than another.
// Accuracy: spheres of 4 to 10 px, at rest and smeared by 2 px, three and ten times saturated, of
//           70 counts at 2 % noise: rms error / stated sigma 0.7 to 1.4 (`glint experiment
//           centroid`). Hardly saturated it states up to eight times too much, as the light does
//           not tell by how much. Of what is no whole disc it is an upper estimate.
// Source:   noise through a ratio of sums; the rim's share is derived in centroid_variance.cpp.
#pragma once

#include <array>

#include "kernels/image/blob_scratch.hpp"
#include "kernels/image/blob_settings.hpp"
#include "kernels/image/centroid.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

// Variances of x and y, px^2. `settings` are those that the blob was found with.
[[nodiscard]] std::array<float, 2> centroid_variance(
    const Centroid& centroid, const Component& component,
    const BlobSettings& settings) noexcept GLINT_NONBLOCKING;

// From this much on a box is no whole disc's: its longer side beyond the shorter, in pixels and in
// parts of the shorter. A disc smeared by two pixels stays below.
inline constexpr int k_excess_least_px = 3;
inline constexpr double k_excess_least_part = 0.75;
// How far off a centroid may be whose blob the frame's border cuts, even if its box is square.
inline constexpr float k_cut_px = 1;

[[nodiscard]] constexpr int excess_px(const Component& component) {
  const int width = component.x1 - component.x0, height = component.y1 - component.y0;
  return width > height ? width - height : height - width;
}
[[nodiscard]] constexpr bool is_uneven(const Component& component) {
  const int width = component.x1 - component.x0, height = component.y1 - component.y0;
  const int shorter = width < height ? width : height;
  return excess_px(component) >= k_excess_least_px &&
         excess_px(component) > k_excess_least_part * shorter;
}

// To be added where the border cuts the blob or where it is uneven: of two discs merged into one
// blob either is half the excess away, and of one half covered the middle is.
[[nodiscard]] std::array<float, 2> shape_variance(const Component& component, bool cut_x,
                                                  bool cut_y) noexcept GLINT_NONBLOCKING;

}  // namespace glint
