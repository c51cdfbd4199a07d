#include "kernels/wire/smallest_three.hpp"

#include <cmath>

#include "kernels/wire/quantize.hpp"

namespace glint {
namespace {

constexpr double k_norm_tolerance = 1e-3;

}  // namespace

SmallestThree to_smallest_three(const Quaternion& rotation) noexcept {
  const std::array<double, 4> q{rotation.x(), rotation.y(), rotation.z(), rotation.w()};
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(std::abs(norm - 1) <= k_norm_tolerance)) return {};

  std::size_t largest = 0;
  for (std::size_t i = 1; i < 4; ++i)
    if (std::abs(q[i]) > std::abs(q[largest])) largest = i;

  const double per_unit = (q[largest] < 0 ? -1.0 : 1.0) / (norm * k_smallest_three_step);
  SmallestThree packed;
  packed.left_out = static_cast<std::uint8_t>(largest);
  std::size_t next = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (i == largest) continue;
    packed.component[next++] =
        static_cast<std::int16_t>(quantize(q[i], per_unit, -32767, 32767).value);
  }
  packed.valid = true;
  return packed;
}

Quaternion from_smallest_three(const SmallestThree& packed) noexcept {
  std::array<double, 3> part{};
  double rest = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    part[i] = packed.component[i] * k_smallest_three_step;
    rest -= part[i] * part[i];
  }
  std::array<double, 4> q{};
  std::size_t next = 0;
  for (std::size_t i = 0; i < 4; ++i)
    q[i] = i == packed.left_out ? std::sqrt(rest > 0 ? rest : 0.0) : part[next++];
  Quaternion rotation(q[3], q[0], q[1], q[2]);
  rotation.normalize();
  return rotation;
}

}  // namespace glint
