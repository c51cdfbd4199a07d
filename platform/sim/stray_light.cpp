#include "platform/sim/stray_light.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "kernels/elementary.hpp"

namespace glint::sim {
namespace {

constexpr double k_halo_inner_px = 1.5;  // inside this radius the core spreads the light
constexpr float k_halo_min = 300;        // counts; a weaker halo is below the sensor's noise
constexpr int k_halo_side = 2 * k_halo_px + 1;
constexpr double k_hot_min = 300, k_hot_max = 30'000;  // counts
constexpr double k_hot_min_m = 0.2, k_hot_max_m = 1;   // range that the pixel returns

using Halo = std::array<float, std::size_t{k_halo_side} * k_halo_side>;

// Inverse square of the radius, normalised to a sum of 1.
Halo halo_shares() {
  std::array<double, std::size_t{k_halo_side} * k_halo_side> shares{};
  double sum = 0;
  for (int y = -k_halo_px; y <= k_halo_px; ++y) {
    for (int x = -k_halo_px; x <= k_halo_px; ++x) {
      const double radius2 = double{1} * (x * x + y * y);
      if (radius2 < k_halo_inner_px * k_halo_inner_px || radius2 > k_halo_px * k_halo_px) continue;
      const auto i = static_cast<std::size_t>((y + k_halo_px) * k_halo_side + x + k_halo_px);
      shares[i] = 1 / radius2;
      sum += shares[i];
    }
  }
  Halo halo{};
  for (std::size_t i = 0; i < halo.size(); ++i) halo[i] = static_cast<float>(shares[i] / sum);
  return halo;
}

// Separable 3 x 3 kernel (share, 1 - 2 share, share); the border repeats.
void spread(float share, Planes& scratch, int width, int height, std::vector<float>& plane) {
  const float kept = 1 - 2 * share;
  for (int y = 0; y < height; ++y) {
    const float* in = &plane[scratch.at(0, y)];
    float* out = &scratch.signal[scratch.at(0, y)];
    out[0] = kept * in[0] + share * (in[0] + in[1]);
    for (int x = 1; x < width - 1; ++x) out[x] = kept * in[x] + share * (in[x - 1] + in[x + 1]);
    out[width - 1] = kept * in[width - 1] + share * (in[width - 2] + in[width - 1]);
  }
  for (int y = 0; y < height; ++y) {
    const float* above = &scratch.signal[scratch.at(0, std::max(y - 1, 0))];
    const float* in = &scratch.signal[scratch.at(0, y)];
    const float* below = &scratch.signal[scratch.at(0, std::min(y + 1, height - 1))];
    float* out = &plane[scratch.at(0, y)];
    for (int x = 0; x < width; ++x) out[x] = kept * in[x] + share * (above[x] + below[x]);
  }
}

// before: the planes without any spread.
void add_halos(const Planes& before, float share, Planes& light) {
  static const Halo halo = halo_shares();
  for (int y = 0; y < light.height; ++y) {
    for (int x = 0; x < light.width; ++x) {
      const std::size_t i = light.at(x, y);
      if (before.signal[i] < k_halo_min) continue;
      const float given = share * before.signal[i], given_range = given * before.range_m[i];
      light.signal[i] -= given;
      light.range_m[i] -= given_range;
      const int x0 = std::max(x - k_halo_px, 0), x1 = std::min(x + k_halo_px, light.width - 1);
      const int y0 = std::max(y - k_halo_px, 0), y1 = std::min(y + k_halo_px, light.height - 1);
      for (int v = y0; v <= y1; ++v) {
        const float* shares = &halo[static_cast<std::size_t>((v - y + k_halo_px) * k_halo_side)];
        for (int u = x0; u <= x1; ++u) {
          light.signal[light.at(u, v)] += given * shares[u - x + k_halo_px];
          light.range_m[light.at(u, v)] += given_range * shares[u - x + k_halo_px];
        }
      }
    }
  }
}

// Eight partial sums: one addition need not wait for the one before it.
double sum_of(const std::vector<float>& values) {
  std::array<double, 8> lanes{};
  const std::size_t whole = values.size() / lanes.size() * lanes.size();
  for (std::size_t i = 0; i < whole; i += lanes.size()) {
    for (std::size_t k = 0; k < lanes.size(); ++k) lanes[k] += double{values[i + k]};
  }
  double sum = 0;
  for (const double lane : lanes) sum += lane;
  for (std::size_t i = whole; i < values.size(); ++i) sum += double{values[i]};
  return sum;
}

// light.range_m holds signal times range, so that both are additive.
void add_stray(const DeviceErrors& device, Planes& light) {
  const double signal = sum_of(light.signal), weighted = sum_of(light.range_m);
  if (!(signal > 0)) return;
  const double each = device.stray_share * signal / static_cast<double>(light.signal.size());
  const auto more = static_cast<float>(each);
  const auto more_range = static_cast<float>(each * (weighted / signal + device.stray_detour_m));
  for (float& value : light.signal) value += more;
  for (float& value : light.range_m) value += more_range;
}

void add_hot_pixels(const DeviceErrors& device, Planes& planes) {
  const RandomKey key{device.seed, Stream::device, 1'000'000};
  for (int k = 0; k < device.hot_pixels; ++k) {
    const auto first = 4 * static_cast<std::uint64_t>(k);
    const auto place = [&](std::uint64_t index, int size) {
      return static_cast<int>(uniform(key, index) * size);
    };
    const std::size_t i = planes.at(place(first, planes.width), place(first + 1, planes.height));
    planes.signal[i] = static_cast<float>(
        k_hot_min * exponential(uniform(key, first + 2) * logarithm(k_hot_max / k_hot_min)));
    planes.range_m[i] =
        static_cast<float>(k_hot_min_m + (k_hot_max_m - k_hot_min_m) * uniform(key, first + 3));
  }
}

}  // namespace

void add_stray_light(const DeviceErrors& device, Planes& scratch, Planes& planes) {
  if (device.spread_share > 0 || device.halo_share > 0 || device.stray_share > 0) {
    const std::size_t count = planes.signal.size();
    scratch = planes;
    for (std::size_t i = 0; i < count; ++i) planes.range_m[i] *= planes.signal[i];
    add_halos(scratch, static_cast<float>(device.halo_share), planes);
    const auto share = static_cast<float>(device.spread_share);
    spread(share, scratch, planes.width, planes.height, planes.signal);
    spread(share, scratch, planes.width, planes.height, planes.range_m);
    add_stray(device, planes);
    // Where no light is, the product with the range is zero too.
    for (std::size_t i = 0; i < count; ++i)
      planes.range_m[i] /= planes.signal[i] > 0 ? planes.signal[i] : 1.0f;
  }
  add_hot_pixels(device, planes);
}

}  // namespace glint::sim
