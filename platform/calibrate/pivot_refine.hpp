// The nonlinear part of pivot calibration: every sample's true rotation is an unknown beside tip
// and post, so that the noise of rotations does not draw the tip towards the centre.
#pragma once

#include <span>

#include "platform/calibrate/pivot_linear.hpp"

namespace glint {

enum class PivotLoss { none, cauchy };

[[nodiscard]] PivotPoint refined_pivot(std::span<const PivotSample> samples,
                                       const PivotPoint& start, PivotLoss loss);

}  // namespace glint
