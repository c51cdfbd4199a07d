#include "platform/sim/random.hpp"

#include <cmath>
#include <numbers>

#include "kernels/elementary.hpp"

namespace glint::sim {
namespace {}  // namespace

double uniform(const RandomKey& key, std::uint64_t index) {
  return (static_cast<double>(key.bits(index) >> 11) + 0.5) * 0x1p-53;
}

double gaussian(const RandomKey& key, std::uint64_t index) {
  const double u = uniform(key, 2 * index);
  const double v = uniform(key, 2 * index + 1);
  return std::sqrt(-2.0 * logarithm(u)) * sine_cosine(2 * std::numbers::pi * v).cosine;
}

Vector3 gaussian_vector(const RandomKey& key, std::uint64_t index) {
  const double x = gaussian(key, 3 * index);
  const double y = gaussian(key, 3 * index + 1);
  const double z = gaussian(key, 3 * index + 2);
  return {x, y, z};
}

std::vector<float> gaussian_table(const RandomKey& key, int count) {
  std::vector<float> table(static_cast<std::size_t>(count));
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double value = gaussian(key, i);
    sum += value;
    squares += value * value;
  }
  const double mean = sum / count;
  const double scale = 1 / std::sqrt(squares / count - mean * mean);
  for (std::size_t i = 0; i < table.size(); ++i) {
    table[i] = static_cast<float>(scale * (gaussian(key, i) - mean));
  }
  return table;
}

}  // namespace glint::sim
