// Labelled markers of one tool in one frame, weighted by the tracker's noise estimate.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "kernels/pose/marker_sight.hpp"
#include "nodes/tokens.hpp"
#include "platform/formats/camera.hpp"

namespace glint {

class LabelledMarkers {
 public:
  // Omits markers that have one of the flags in `rejected_flags`.
  LabelledMarkers(const Markers& all, const Labeling& labeling, const Tool& tool,
                  const MarkerNoise& noise, unsigned rejected_flags) noexcept;

  [[nodiscard]] std::span<const WeightedMarker> weighted() const {
    return {markers_.data(), count_};
  }
  [[nodiscard]] std::span<const LocalRays> sights() const { return {rays_.data(), count_}; }
  // Index in the tool of each marker.
  [[nodiscard]] std::span<const int> marker_indices() const { return {of_tool_.data(), count_}; }

 private:
  std::array<WeightedMarker, k_markers_per_tool_max> markers_;
  std::array<LocalRays, k_markers_per_tool_max> rays_;
  std::array<int, k_markers_per_tool_max> of_tool_{};
  std::size_t count_ = 0;
};

// Returns the declared noise until residuals give an estimate.
[[nodiscard]] MarkerNoise noise_of(const NoiseEstimate& estimate, const Camera& camera) noexcept;

}  // namespace glint
