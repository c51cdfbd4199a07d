// Formatting of figures for messages.
#pragma once

#include <cstdio>
#include <string>

#include "kernels/angles.hpp"
#include "kernels/geometry.hpp"

namespace glint {

[[nodiscard]] inline std::string format_number(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

[[nodiscard]] inline std::string format_mm(double metres) {
  return format_number("%.3g mm", metres * 1e3);
}

[[nodiscard]] inline std::string format_degrees(double radians) {
  return format_number("%.3g deg", radians * k_degrees_per_radian);
}

[[nodiscard]] inline std::string format_direction(const Vector3& d) {
  char text[80];
  std::snprintf(text, sizeof text, "[%.2f, %.2f, %.2f]", d.x(), d.y(), d.z());
  return text;
}

}  // namespace glint
