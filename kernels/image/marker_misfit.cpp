#include "kernels/image/marker_misfit.hpp"

#include <algorithm>
#include <cstdint>

#include "kernels/image/centroid_variance.hpp"

namespace glint {
namespace {

// Returns the raw depth, or 0 if no sampled pixel has one.
std::uint16_t depth_of(const Frame& frame, const Component& component, const MarkerSizes& sizes) {
  const int x = (component.x0 + component.x1 - 1) / 2, y = (component.y0 + component.y1 - 1) / 2;
  const auto valid_at = [&](int column, int row) -> std::uint16_t {
    const std::uint16_t raw = frame.depth.row(row)[column];
    return raw < sizes.invalid_from ? raw : std::uint16_t{0};
  };
  std::uint16_t raw = valid_at(x, y);
  if (raw == 0) raw = valid_at(component.x0, y);
  if (raw == 0) raw = valid_at(component.x1 - 1, y);
  if (raw == 0) raw = valid_at(x, component.y0);
  if (raw == 0) raw = valid_at(x, component.y1 - 1);
  return raw;
}

SizeGate expected_sizes(const Frame& frame, const Component& component, const MarkerSizes& sizes) {
  if (frame.depth.empty()) return sizes.without_depth;
  const std::uint16_t raw = depth_of(frame, component, sizes);
  if (raw == 0) return sizes.without_depth;
  const int bin = std::min(raw >> sizes.depth_shift, k_depth_bins - 1);
  return sizes.by_depth[static_cast<std::size_t>(bin)];
}

// One step for each factor of two by which `less` is below `more`, at most three.
int steps_below(std::uint64_t less, std::uint64_t more) {
  return static_cast<int>(less < more) + static_cast<int>(2 * less < more) +
         static_cast<int>(4 * less < more);
}

bool has_low_contrast(const Frame& frame, const Component& component, std::uint16_t threshold) {
  const int x = (component.x0 + component.x1 - 1) / 2, y = (component.y0 + component.y1 - 1) / 2;
  const int level = frame.reflectivity_8.empty() ? int{frame.reflectivity_16.row(y)[x]}
                                                 : int{frame.reflectivity_8.row(y)[x]};
  return level < 2 * threshold;
}

}  // namespace

int marker_misfit(const Frame& frame, const Component& component,
                  const BlobSettings& settings) noexcept {
  int steps =
      has_low_contrast(frame, component, std::max(settings.threshold, component.level)) ? 1 : 0;
  const int width = component.x1 - component.x0, height = component.y1 - component.y0;
  const std::uint64_t area = component.area_px;
  const auto box = static_cast<std::uint64_t>(width * height);
  if (is_partial_or_merged(component) || 2 * area < box) ++steps;
  if (settings.sizes.known) {
    const SizeGate gate = expected_sizes(frame, component, settings.sizes);
    steps += steps_below(area, gate.min_area_px) + steps_below(gate.max_area_px, area);
  }
  return std::min(steps, k_misfit_max);
}

}  // namespace glint
