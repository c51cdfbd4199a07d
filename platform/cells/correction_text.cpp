#include "platform/cells/correction_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "kernels/angles.hpp"

namespace glint {
namespace {

// Callers pass the larger cosine first, for rising angles.
double degrees(double cosine) {
  return k_degrees_per_radian * std::acos(std::clamp(cosine, -1.0, 1.0));
}

}  // namespace

std::string correction_text(const BiasCorrection& correction) {
  if (correction.frame == CorrectionFrame::none) return {};
  char text[240];
  std::snprintf(text, sizeof text,
                "%.2f mm, %.2f deg along the %s axes, valid from %.0f to %.0f mm, %.0f to %.0f deg "
                "off the axis, tilted by %.0f to %.0f deg",
                1e3 * correction.translation_m.norm(),
                k_degrees_per_radian * correction.rotation_rad.norm(),
                correction.frame == CorrectionFrame::tool ? "tool's" : "camera's",
                1e3 * correction.range_m.from, 1e3 * correction.range_m.to,
                degrees(correction.off_axis_cosine.to), degrees(correction.off_axis_cosine.from),
                degrees(correction.tilt_cosine.to), degrees(correction.tilt_cosine.from));
  return text;
}

}  // namespace glint
