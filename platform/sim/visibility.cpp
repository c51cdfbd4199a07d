#include "platform/sim/visibility.hpp"

namespace glint::sim {
namespace {

bool is_isolated(const Scene& scene, const RenderedReflectors& drawn, int index) {
  const RenderedReflector& own = drawn[static_cast<std::size_t>(index)];
  for (int i = 0; i < scene.reflectors.count; ++i) {
    const RenderedReflector& other = drawn[static_cast<std::size_t>(i)];
    if (i == index || other.peak_signal == 0) continue;  // a hidden reflector merges with none
    const double reach = own.radius_px + other.radius_px + k_gap_px;
    if ((own.pixel - other.pixel).squaredNorm() < reach * reach) return false;
  }
  return true;
}

}  // namespace

void find_visible(const Camera& camera, const Scene& scene, const RenderedReflectors& drawn,
                  std::vector<std::uint8_t>& masks) {
  for (std::uint8_t& mask : masks) mask = 0;
  for (int i = 0; i < scene.reflectors.count; ++i) {
    const Reflector& reflector = scene.reflectors[i];
    if (reflector.tool < 0) continue;
    const RenderedReflector& own = drawn[static_cast<std::size_t>(i)];
    const double range = reflector.centre.norm();
    const bool visible = own.visible_fraction >= k_visible_fraction_min &&
                         range >= camera.range_min_m && range <= camera.range_max_m &&
                         is_isolated(scene, drawn, i);
    if (!visible) continue;
    std::uint8_t& mask = masks[static_cast<std::size_t>(reflector.tool)];
    mask = static_cast<std::uint8_t>(mask | (1u << reflector.marker));
  }
}

}  // namespace glint::sim
