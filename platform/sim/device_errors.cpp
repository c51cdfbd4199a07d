#include "platform/sim/device_errors.hpp"

#include <cmath>
#include <numbers>

#include "kernels/elementary.hpp"

namespace glint::sim {
namespace {

constexpr double k_two_pi = 2 * std::numbers::pi;
constexpr int k_oscillations = 6;
constexpr int k_lens_waves = 4;
constexpr double k_lens_wave_px = 350;  // mean wavelength

double sine(double radians) { return sine_cosine(radians).sine; }

// Correlated error: sum of sines with random phases and stratified log-uniform frequencies.
// Variance 1 over long times.
double slow_error(const RandomKey& key, std::uint64_t part, double seconds) {
  const double span = logarithm(k_fastest_hz / k_slowest_hz);
  double sum = 0;
  for (std::uint64_t k = 0; k < k_oscillations; ++k) {
    const std::uint64_t index = 2 * (part * k_oscillations + k);
    const double share = (static_cast<double>(k) + uniform(key, index)) / k_oscillations;
    const double hz = k_slowest_hz * exponential(span * share);
    sum += sine(k_two_pi * (hz * seconds + uniform(key, index + 1)));
  }
  return sum * std::sqrt(2.0 / k_oscillations);
}

// Smooth lens residual: sum of random plane waves. Variance 1 over the image.
double lens_field(const RandomKey& key, std::uint64_t axis, const Vector2& pixel) {
  double sum = 0;
  for (std::uint64_t k = 0; k < k_lens_waves; ++k) {
    const std::uint64_t index = axis * k_lens_waves + k;
    const Vector3 wave = gaussian_vector(key, 2 * index);
    const double turns = (wave.x() * pixel.x() + wave.y() * pixel.y()) / k_lens_wave_px;
    sum += sine(k_two_pi * (turns + uniform(key, 1'000'000 + index)));
  }
  return sum * std::sqrt(2.0 / k_lens_waves);
}

}  // namespace

MarkerError marker_error(const DeviceErrors& device, const Vector2& pixel,
                         const Vector2& principal_point_px, double range_m, std::uint64_t number,
                         Time time) {
  const RandomKey of_lens{device.seed, Stream::device, 0},
      of_marker{device.seed, Stream::device, 1 + number};
  const double seconds = Duration{time.nanoseconds}.seconds();
  MarkerError error;
  error.shift_px = device.principal_point_px + device.focal_scale * (pixel - principal_point_px);
  if (device.lens_residual_px > 0) {
    error.shift_px += device.lens_residual_px *
                      Vector2(lens_field(of_lens, 0, pixel), lens_field(of_lens, 1, pixel));
  }
  if (device.correlated_centroid_px > 0) {
    error.shift_px += device.correlated_centroid_px *
                      Vector2(slow_error(of_marker, 0, seconds), slow_error(of_marker, 1, seconds));
  }
  error.range_m = device.range_offset_m + device.range_scale * range_m;
  if (device.range_wiggle_m > 0) {
    const double phase = uniform(of_lens, 2'000'000);
    error.range_m += device.range_wiggle_m * sine(k_two_pi * (range_m / k_wiggle_period_m + phase));
  }
  if (device.correlated_range_m > 0) {
    error.range_m += device.correlated_range_m * slow_error(of_marker, 2, seconds);
  }
  return error;
}

}  // namespace glint::sim
