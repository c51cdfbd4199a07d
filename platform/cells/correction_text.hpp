// Text of a bias correction for a run's report, separate from the tracker's own figures.
#pragma once

#include <cstdint>
#include <string>

#include "kernels/pose/bias_correction.hpp"

namespace glint {

// Returns "1.20 mm, 0.30 deg along the tool's axes, valid from 350 to 650 mm, 0 to 20 deg off the
// axis, tilted by 80 to 110 deg". Empty without correction.
[[nodiscard]] std::string correction_text(const BiasCorrection& correction);

}  // namespace glint
