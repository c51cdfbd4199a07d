#include "kernels/elementary.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace glint {
namespace {

// Constants that need more than double precision are sums of doubles. All parts but the last have
// so few bits that their product with the reduction's integer is exact.
constexpr double k_two_over_pi = 0x1.45f306dc9c883p-1;
constexpr double k_half_pi_1 = 0x1.921fb544p+0;  // 33 bits
constexpr double k_half_pi_2 = 0x1.0b4611a6p-34;
constexpr double k_half_pi_3 = 0x1.3198a2e037073p-69;
constexpr double k_inverse_log_2 = 0x1.71547652b82fep+0;
constexpr double k_log_2_high = 0x1.62e42feep-1;  // 32 bits
constexpr double k_log_2_low = 0x1.a39ef35793c76p-33;
constexpr double k_pi_high = 0x1.921fb54442d18p+1;
constexpr double k_pi_low = 0x1.1a62633145c07p-53;

struct HighLow {
  double high;
  double low;
};

// atan(i/8).
constexpr HighLow k_arc_tangent_eighths[9] = {{0, 0},
                                              {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                              {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                              {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                              {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                              {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                              {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                              {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                              {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};

double clamped(double x, double low, double high) {
  if (!(x == x)) return 0;
  return x < low ? low : x > high ? high : x;
}

// sin(r + tail), |r| <= pi/4: terms to r^17; the next is 8e-20.
double sine_series(double r, double tail) {
  const double s = r * r;
  double p = 1.0 / 355687428096000.0;
  p = p * s - 1.0 / 1307674368000.0;
  p = p * s + 1.0 / 6227020800.0;
  p = p * s - 1.0 / 39916800.0;
  p = p * s + 1.0 / 362880.0;
  p = p * s - 1.0 / 5040.0;
  p = p * s + 1.0 / 120.0;
  p = p * s - 1.0 / 6.0;
  return r + (r * s * p + tail * (1.0 - 0.5 * s));
}

// cos(r + tail), |r| <= pi/4: terms to r^16; the next is 2e-18.
double cosine_series(double r, double tail) {
  const double s = r * r;
  double p = 1.0 / 20922789888000.0;
  p = p * s - 1.0 / 87178291200.0;
  p = p * s + 1.0 / 479001600.0;
  p = p * s - 1.0 / 3628800.0;
  p = p * s + 1.0 / 40320.0;
  p = p * s - 1.0 / 720.0;
  p = p * s + 1.0 / 24.0;
  const double half = 0.5 * s;
  const double whole = 1.0 - half;
  return whole + (((1.0 - whole) - half) + (s * s * p - r * tail));
}

// Arc tangent of a ratio in [0, 1], as high + low.
HighLow arc_tangent_of_ratio(double t) {
  const int i = static_cast<int>(t * 8.0 + 0.5);
  const double c = i * 0.125;
  const double z = (t - c) / (1.0 + t * c);  // |z| <= 1/16
  const double s = z * z;
  double p = 1.0 / 13.0;  // terms to z^13; the next is 6e-20
  p = p * s - 1.0 / 11.0;
  p = p * s + 1.0 / 9.0;
  p = p * s - 1.0 / 7.0;
  p = p * s + 1.0 / 5.0;
  p = p * s - 1.0 / 3.0;
  const HighLow base = k_arc_tangent_eighths[i];
  const double small = z + (z * s * p + base.low);
  const double high = base.high + small;
  return {high, (base.high - high) + small};
}

}  // namespace

SineCosine sine_cosine(double radians) noexcept {
  const double x = clamped(radians, -1e5, 1e5);
  const double turns = std::floor(x * k_two_over_pi + 0.5);
  const double first = x - turns * k_half_pi_1;  // exact: no operand has a bit below 2^-53
  const double piece = turns * k_half_pi_2;
  const double middle = first - piece;
  const double back = first - middle;  // Knuth's two-sum: rounding error of middle
  const double error = (first - (middle + back)) + (back - piece);
  const double low = error - turns * k_half_pi_3;
  const double r = middle + low;
  const double tail = (middle - r) + low;
  const double sine = sine_series(r, tail);
  const double cosine = cosine_series(r, tail);
  switch (static_cast<std::int32_t>(turns) & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

double logarithm(double x) noexcept {
  constexpr double smallest = std::numeric_limits<double>::denorm_min();
  double value = x > smallest ? x : smallest;
  if (value > std::numeric_limits<double>::max()) value = std::numeric_limits<double>::max();
  int exponent = 0;
  if (value < std::numeric_limits<double>::min()) {
    value *= 0x1p54;
    exponent = -54;
  }
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(value);
  exponent += static_cast<int>(bits >> 52) - 1023;
  double mantissa =
      std::bit_cast<double>((bits & 0x000FFFFFFFFFFFFFu) | 0x3FF0000000000000u);  // [1, 2)
  if (mantissa > 1.4142135623730951) {
    mantissa *= 0.5;
    ++exponent;
  }
  // log(1+f) = 2 atanh(q), q = f/(2+f), |q| <= 0.172: terms to q^21; the next is 6e-19 of the sum.
  // As 2q = f - qf, the large term f is exact.
  const double f = mantissa - 1.0;
  const double q = f / (2.0 + f);
  const double s = q * q;
  double p = 2.0 / 21.0;
  p = p * s + 2.0 / 19.0;
  p = p * s + 2.0 / 17.0;
  p = p * s + 2.0 / 15.0;
  p = p * s + 2.0 / 13.0;
  p = p * s + 2.0 / 11.0;
  p = p * s + 2.0 / 9.0;
  p = p * s + 2.0 / 7.0;
  p = p * s + 2.0 / 5.0;
  p = p * s + 2.0 / 3.0;
  const double correction = exponent * k_log_2_low - q * (f - p * s);
  const double high = exponent * k_log_2_high;
  const double sum = high + f;
  const double rest = (high - sum) + f;
  return sum + (rest + correction);
}

double exponential(double x) noexcept {
  const double value = clamped(x, -700.0, 700.0);
  const double doublings = std::floor(value * k_inverse_log_2 + 0.5);
  const double high = value - doublings * k_log_2_high;  // exact
  const double low = doublings * k_log_2_low;
  const double r = high - low;
  const double tail = (high - r) - low;
  double p = 1.0 / 87178291200.0;  // terms to r^14, |r| <= 0.347; the next is 1e-19
  p = p * r + 1.0 / 6227020800.0;
  p = p * r + 1.0 / 479001600.0;
  p = p * r + 1.0 / 39916800.0;
  p = p * r + 1.0 / 3628800.0;
  p = p * r + 1.0 / 362880.0;
  p = p * r + 1.0 / 40320.0;
  p = p * r + 1.0 / 5040.0;
  p = p * r + 1.0 / 720.0;
  p = p * r + 1.0 / 120.0;
  p = p * r + 1.0 / 24.0;
  p = p * r + 1.0 / 6.0;
  p = p * r + 0.5;
  const double sum = 1.0 + (r + (r * r * p + tail * (1.0 + r)));
  const auto exponent = static_cast<std::uint64_t>(static_cast<int>(doublings) + 1023);
  return sum * std::bit_cast<double>(exponent << 52);
}

double arc_tangent(double y, double x) noexcept {
  constexpr double largest = std::numeric_limits<double>::max();
  const double up = std::abs(clamped(y, -largest, largest));
  const double along = std::abs(clamped(x, -largest, largest));
  const bool steep = up > along;
  const double longer = steep ? up : along;
  const double ratio = longer > 0 ? (steep ? along : up) / longer : 0.0;
  const HighLow angle = arc_tangent_of_ratio(ratio);
  // The angle from the x axis is base + sign * angle: reflected at 45 degrees, then at 90.
  double value = angle.high + angle.low;
  if (steep) {
    const double side = std::signbit(x) ? 1.0 : -1.0;
    value = 0.5 * k_pi_high + (side * angle.high + (0.5 * k_pi_low + side * angle.low));
  } else if (std::signbit(x)) {
    value = k_pi_high - (angle.high - (k_pi_low - angle.low));
  }
  return std::signbit(y) ? -value : value;
}

double arc_cosine(double x) noexcept {
  const double value = clamped(x, -1.0, 1.0);
  return arc_tangent(std::sqrt((1.0 - value) * (1.0 + value)), value);
}

}  // namespace glint
