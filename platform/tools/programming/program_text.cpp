#include "platform/tools/programming/program_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "platform/input_error.hpp"

namespace glint {

std::string fixed_text(double number, int digits) {
  std::array<char, 512> text;  // the largest double has 309 digits before the point
  const double clean = std::abs(number) < 0.5 * std::pow(10.0, -digits) ? 0.0 : number;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), clean, std::chars_format::fixed, digits)
          .ptr;
  return {text.data(), end};
}

// x from Rz(-z) R instead of from R's last row: next to y = +-90 degrees that row vanishes, and the
// rounding error of z would not be compensated by x.
EulerAngles euler_angles(const Quaternion& rotation) {
  constexpr double k_degrees = 180 / std::numbers::pi;
  const Matrix3 r = rotation.toRotationMatrix();
  const double z = std::atan2(r(1, 0), r(0, 0));
  const double y = std::atan2(-r(2, 0), std::hypot(r(0, 0), r(1, 0)));
  const double s = std::sin(z), c = std::cos(z);
  const double x = std::atan2(s * r(0, 2) - c * r(1, 2), c * r(1, 1) - s * r(0, 1));
  return {k_degrees * z, k_degrees * y, k_degrees * x};
}

std::string upper_case(std::string text) {
  for (char& c : text) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return text;
}

void check_name(const std::string& name, const NameRule& rule) {
  const std::string place = std::string(rule.dialect) + ": name \"" + name + "\"; expected ";
  if (name.size() > rule.length_max) {
    throw InputError(place + "at most " + std::to_string(rule.length_max) + " characters");
  }
  const std::string upper = upper_case(name);
  if (std::find(rule.reserved.begin(), rule.reserved.end(), upper) != rule.reserved.end()) {
    throw InputError(place + "no reserved word");
  }
}

void check_number(double number, double low, double high, std::string_view dialect,
                  std::string_view setting) {
  if (number >= low && number <= high) return;
  const auto plain = [](double value) {
    std::string text = fixed_text(value, 3);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
  };
  throw InputError(std::string(dialect) + ": " + std::string(setting) + " is " + plain(number) +
                   "; expected " + plain(low) + " to " + plain(high));
}

}  // namespace glint
