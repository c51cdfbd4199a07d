// Text that the post-processors share: numbers, names, angles.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "kernels/geometry.hpp"

namespace glint {

// Decimal fraction with this number of digits, independent of the locale; never "-0.000".
[[nodiscard]] std::string fixed_text(double number, int digits);

// Angles of R = Rz(z) Ry(y) Rx(x): about the moving axes z, y, x or the fixed axes x, y, z.
// KUKA's A, B, C and FANUC's R, P, W.
struct EulerAngles {
  double z_deg = 0, y_deg = 0, x_deg = 0;
};

// y_deg is in [-90, 90]. At +-90 degrees z_deg is arbitrary and x_deg fits to it.
[[nodiscard]] EulerAngles euler_angles(const Quaternion& rotation);

struct NameRule {
  std::string_view dialect;
  std::size_t length_max;
  std::span<const std::string_view> reserved;  // upper case
};

// Throws InputError if the name, in any case, is too long or a reserved word.
void check_name(const std::string& name, const NameRule& rule);

// Throws InputError naming dialect and setting if the number is outside of [low, high].
void check_number(double number, double low, double high, std::string_view dialect,
                  std::string_view setting);

[[nodiscard]] std::string upper_case(std::string text);

}  // namespace glint
