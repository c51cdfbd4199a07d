#include "kernels/image/blob_settings.hpp"

#include <algorithm>
#include <numbers>

namespace glint {
namespace {

constexpr double k_least_visible = 0.3;  // of the disc: a marker two thirds hidden is of no use
constexpr double k_most_visible = 1.5;   // stray light and motion during the exposure
constexpr double k_blur_px = 1.0;        // by how much the lens widens a small disc's radius
constexpr double k_area_max_px = 512.0 * 512.0;

}  // namespace

SizeGate size_gate(double radius_m, double range_min_m, double range_max_m,
                   double focal_px) noexcept {
  SizeGate gate{1, static_cast<std::uint32_t>(k_area_max_px)};
  if (!(radius_m > 0) || !(range_min_m > 0) || !(range_max_m >= range_min_m) || !(focal_px > 0)) {
    return gate;
  }
  const double far_px = focal_px * radius_m / range_max_m;
  const double near_px = focal_px * radius_m / range_min_m + k_blur_px;
  const double least =
      std::clamp(k_least_visible * std::numbers::pi * far_px * far_px, 1.0, k_area_max_px);
  const double most =
      std::clamp(k_most_visible * std::numbers::pi * near_px * near_px, 1.0, k_area_max_px);
  gate.min_area_px = static_cast<std::uint32_t>(least);
  gate.max_area_px = static_cast<std::uint32_t>(most) + 1;
  return gate;
}

}  // namespace glint
