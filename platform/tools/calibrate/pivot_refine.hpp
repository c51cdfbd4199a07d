// Nonlinear pivot calibration: each sample's true rotation is an unknown beside tip and post, so
// that rotation noise does not bias the tip towards the centre.
#pragma once

#include <span>

#include "platform/tools/calibrate/pivot_linear.hpp"

namespace glint {

enum class PivotLoss { none, cauchy };

[[nodiscard]] PivotPoint refined_pivot(std::span<const PivotSample> samples,
                                       const PivotPoint& start, PivotLoss loss);

}  // namespace glint
