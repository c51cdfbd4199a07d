#include "kernels/cloud/plane_sample.hpp"

#include <cmath>

#include "kernels/cloud/four_floats.hpp"

namespace glint {
namespace {

FourFloats absolute(const FourFloats& value) {
  return reinterpret_cast<FourFloats>(reinterpret_cast<FourMasks>(value) & 0x7FFFFFFF);
}

}  // namespace

Reason PlaneSample::prepare(Arena& arena) noexcept {
  count_ = 0;
  for (Column<float>* column : {&x_, &y_, &z_, &nx_, &ny_, &nz_}) {
    if (!column->reserve(k_plane_sample, arena)) return Reason::not_prepared;
  }
  return Reason::none;
}

void PlaneSample::add(const PointCloud& cloud, int point) noexcept {
  if (count_ == k_plane_sample) return;
  x_[count_] = cloud.x[point], y_[count_] = cloud.y[point], z_[count_] = cloud.z[point];
  nx_[count_] = cloud.normal_x[point], ny_[count_] = cloud.normal_y[point];
  nz_[count_++] = cloud.normal_z[point];
}

bool PlaneSample::candidate_of(std::uint64_t drawn, const PlaneGate& gate,
                               CandidatePlane& out) const noexcept {
  const auto pick = [&](int shift) {
    const std::uint64_t part = drawn >> shift & 0xFFFFF;  // 20 bits for at most 2,048 points
    return static_cast<int>(part * static_cast<std::uint64_t>(count_) >> 20);
  };
  const int a = pick(0), b = pick(20), c = pick(40);
  const float ux = x_[b] - x_[a], uy = y_[b] - y_[a], uz = z_[b] - z_[a];
  const float vx = x_[c] - x_[a], vy = y_[c] - y_[a], vz = z_[c] - z_[a];
  const float nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const float length = std::sqrt(nx * nx + ny * ny + nz * nz);
  const float least = gate.normal_cosine_min * length;
  // Also false for collinear points, whose length is zero, and for NaN.
  for (const int i : {a, b, c}) {
    const float along = std::abs(nx * nx_[i] + ny * ny_[i] + nz * nz_[i]);
    if (!(along >= least && length > 0)) return false;
  }
  out = {nx / length, ny / length, nz / length, 0};
  out.offset_m = out.nx * x_[a] + out.ny * y_[a] + out.nz * z_[a];
  return true;
}

int PlaneSample::score(const CandidatePlane& plane, const PlaneGate& gate) const noexcept {
  const FourFloats nx = broadcast_four(plane.nx), ny = broadcast_four(plane.ny),
                   nz = broadcast_four(plane.nz);
  const FourFloats threshold = broadcast_four(gate.threshold_m);
  const FourFloats cosine = broadcast_four(gate.normal_cosine_min);
  FourMasks on{};
  for (int i = 0; i < count_; i += 4) {
    const FourFloats height = nx * load_four(x_.data() + i) + ny * load_four(y_.data() + i) +
                              nz * load_four(z_.data() + i) - plane.offset_m;
    const FourFloats along = nx * load_four(nx_.data() + i) + ny * load_four(ny_.data() + i) +
                             nz * load_four(nz_.data() + i);
    on += (absolute(height) <= threshold) & (absolute(along) >= cosine) & first_lanes(count_ - i);
  }
  return count_of(on);
}

}  // namespace glint
