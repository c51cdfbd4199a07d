#include "platform/sim/sensor.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/limits.hpp"
#include "platform/sim/random.hpp"

namespace glint::sim {
namespace {

constexpr int k_table_starts = 1 << 16;  // 256 kB: fits the second-level cache
constexpr int k_table_row = 512;         // minimum row length: the same table for smaller cameras

float min_of(float a, float b) { return a < b ? a : b; }
float max_of(float a, float b) { return a > b ? a : b; }

// Single precision, branch-free, each operation rounded separately: vectorised code of any compiler
// gives the same bits.
template <class Pixel>
void reflectivity_row(const float* signal, const float* normal, const std::uint16_t* mask,
                      const NoiseSettings& noise, float ceiling, int width, Pixel* out) {
  const auto read2 = static_cast<float>(noise.read_sigma * noise.read_sigma);
  const auto shot = static_cast<float>(noise.shot_counts);
  for (int x = 0; x < width; ++x) {
    const float noisy = signal[x] + normal[x] * std::sqrt(read2 + shot * signal[x]);
    const float limited = min_of(max_of(noisy + 0.5f, 0.0f), ceiling);
    out[x] = static_cast<Pixel>(static_cast<std::int32_t>(limited) & mask[x]);
  }
}

struct DepthRow {
  float floor2, weak2, signal_min, saturation, wrap, inverse_wrap, counts_per_m, invalid_from;
};

DepthRow depth_row_of(const DepthSettings& depth, const NoiseSettings& noise) {
  const double wrap = depth.wrap_range_m > 0 ? depth.wrap_range_m : 1e6;
  return {static_cast<float>(noise.depth_floor_m * noise.depth_floor_m),
          static_cast<float>(100 * noise.depth_at_100_counts_m * noise.depth_at_100_counts_m),
          static_cast<float>(noise.signal_min),
          static_cast<float>(noise.depth_saturation),
          static_cast<float>(wrap),
          static_cast<float>(1 / wrap),
          static_cast<float>(1 / depth.unit_m),
          static_cast<float>(depth.invalid_from)};
}

// along: z of the ray if depth is along the axis, otherwise 1.
void depth_row(const float* signal, const float* range, const float* normal, const float* along,
               const std::uint16_t* mask, const DepthRow& row, int width, std::uint16_t* out) {
  for (int x = 0; x < width; ++x) {
    const float sigma = std::sqrt(row.floor2 + row.weak2 / max_of(signal[x], 1.0f));
    const float noisy = min_of(max_of(range[x] + normal[x] * sigma, 0.0f), 1000.0f);
    const float turns = static_cast<float>(static_cast<std::int32_t>(noisy * row.inverse_wrap));
    const float wrapped = max_of(noisy - turns * row.wrap, 0.0f) * along[x];
    const float raw = min_of(wrapped * row.counts_per_m + 0.5f, 65535.0f);
    float kept = signal[x] >= row.signal_min ? raw : 0.0f;
    kept = signal[x] < row.saturation ? kept : 0.0f;
    kept = range[x] > 0.0f ? kept : 0.0f;
    kept = raw < row.invalid_from ? kept : 0.0f;
    out[x] = static_cast<std::uint16_t>(static_cast<std::int32_t>(kept) & mask[x]);
  }
}

}  // namespace

Sensor::Sensor(const Camera& camera, const NoiseSettings& noise, std::uint64_t seed)
    : camera_(camera),
      noise_(noise),
      seed_(seed),
      table_(gaussian_table({seed, Stream::noise_table},
                            k_table_starts + std::max(k_table_row, camera.model.width))) {}

void Sensor::expose(const Planes& planes, const LensRays& rays, std::uint64_t sequence,
                    FrameBuffer& out) const {
  static const std::vector<float> ones(k_width_max, 1.0f);
  const int width = planes.width, height = planes.height;
  const bool eight_bit = camera_.reflectivity_bits == 8;
  const std::size_t count = planes.signal.size();
  out.width = width;
  out.height = height;
  out.reflectivity_8.resize(eight_bit ? count : 0);
  out.reflectivity_16.resize(eight_bit ? 0 : count);
  out.depth.resize(count);
  const DepthRow row = depth_row_of(camera_.depth, noise_);
  const RandomKey key{seed_, Stream::row_offset, sequence};
  for (int y = 0; y < height; ++y) {
    const std::size_t i = planes.at(0, y);
    const std::uint64_t place = key.bits(static_cast<std::uint64_t>(y));
    const float* first = table_.data() + place % k_table_starts;
    const float* second = table_.data() + (place >> 32) % k_table_starts;
    const float* signal = planes.signal.data() + i;
    const std::uint16_t* mask = rays.mask_row(y);
    if (eight_bit) {
      reflectivity_row(signal, first, mask, noise_, 255.0f, width, out.reflectivity_8.data() + i);
    } else {
      reflectivity_row(signal, first, mask, noise_, 65535.0f, width,
                       out.reflectivity_16.data() + i);
    }
    const float* along = camera_.depth.kind == DepthKind::z ? rays.z_row(y) : ones.data();
    depth_row(signal, planes.range_m.data() + i, second, along, mask, row, width,
              out.depth.data() + i);
  }
}

}  // namespace glint::sim
