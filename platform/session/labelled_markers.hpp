// The labelled markers of one tool in one frame, weighed by the noise that the tracker estimates.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "kernels/pose/marker_sight.hpp"
#include "nodes/tokens.hpp"
#include "platform/sensors/camera.hpp"

namespace glint {

class LabelledMarkers {
 public:
  // Without those that have one of these marker flags.
  LabelledMarkers(const Markers& all, const Labeling& labeling, const Tool& tool,
                  const MarkerNoise& noise, unsigned without_flags) noexcept;

  [[nodiscard]] std::span<const WeightedMarker> weighed() const {
    return {markers_.data(), count_};
  }
  [[nodiscard]] std::span<const LocalRays> sights() const { return {rays_.data(), count_}; }
  // Which of the tool's markers each is.
  [[nodiscard]] std::span<const int> numbers() const { return {of_tool_.data(), count_}; }

 private:
  std::array<WeightedMarker, k_markers_per_tool_max> markers_;
  std::array<LocalRays, k_markers_per_tool_max> rays_;
  std::array<int, k_markers_per_tool_max> of_tool_{};
  std::size_t count_ = 0;
};

// The declared noise until residuals show another.
[[nodiscard]] MarkerNoise noise_of(const NoiseEstimate& estimate, const Camera& camera) noexcept;

}  // namespace glint
