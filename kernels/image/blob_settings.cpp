#include "kernels/image/blob_settings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/limits.hpp"

namespace glint {
namespace {

constexpr double k_visible_min = 0.3;  // of the disc: a marker two thirds occluded is of no use
constexpr double k_visible_max = 1.5;  // stray light and motion blur
constexpr double k_blur_px = 1.0;      // added by the lens to a small disc's radius
constexpr double k_area_max_px = double{k_width_max} * k_height_max;

}  // namespace

SizeGate size_gate(double radius_m, double range_min_m, double range_max_m,
                   double focal_px) noexcept {
  SizeGate gate{1, static_cast<std::uint32_t>(k_area_max_px)};
  if (!(radius_m > 0) || !(range_min_m > 0) || !(range_max_m >= range_min_m) || !(focal_px > 0)) {
    return gate;
  }
  const double far_px = focal_px * radius_m / range_max_m;
  const double near_px = focal_px * radius_m / range_min_m + k_blur_px;
  const double area_min =
      std::clamp(k_visible_min * std::numbers::pi * far_px * far_px, 1.0, k_area_max_px);
  const double area_max =
      std::clamp(k_visible_max * std::numbers::pi * near_px * near_px, 1.0, k_area_max_px);
  gate.min_area_px = static_cast<std::uint32_t>(area_min);
  gate.max_area_px = static_cast<std::uint32_t>(area_max) + 1;
  return gate;
}

MarkerSizes marker_sizes(const MarkerOptics& optics) noexcept {
  MarkerSizes sizes;
  const double near_m = optics.range_min_m, far_m = optics.range_max_m;
  if (!(optics.radius_min_m > 0) || !(optics.radius_max_m >= optics.radius_min_m) ||
      !(near_m > 0) || !(far_m >= near_m) || !(optics.focal_px > 0) || !(optics.depth_unit_m > 0))
    return sizes;
  const auto sizes_between = [&](double from_m, double to_m) {
    const double radius_px = optics.focal_px * optics.radius_min_m / to_m;
    const double area_min = optics.visible_part_min * std::numbers::pi * radius_px * radius_px;
    SizeGate gate = size_gate(optics.radius_max_m, from_m, to_m, optics.focal_px);
    gate.min_area_px =
        static_cast<std::uint32_t>(std::clamp(std::ceil(area_min), 1.0, k_area_max_px));
    return gate;
  };
  sizes.known = true;
  sizes.invalid_from = optics.depth_invalid_from;
  while ((optics.depth_invalid_from - 1) >> sizes.depth_shift >= k_depth_bins) ++sizes.depth_shift;
  sizes.without_depth = sizes_between(near_m, far_m);
  for (int bin = 0; bin < k_depth_bins; ++bin) {
    const double from_m = optics.depth_unit_m * (bin << sizes.depth_shift);
    const double to_m = optics.depth_unit_m * ((bin + 1) << sizes.depth_shift);
    sizes.by_depth[static_cast<std::size_t>(bin)] =
        sizes_between(std::clamp(from_m, near_m, far_m), std::clamp(to_m, near_m, far_m));
  }
  return sizes;
}

}  // namespace glint
