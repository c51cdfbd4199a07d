#include "kernels/cloud/voxel_grid.hpp"

#include <cmath>

namespace glint {
namespace {

// Voxel index along one axis, part of the key; -1 outside the grid.
std::int64_t place_of(float coordinate, float inverse) {
  const float scaled = coordinate * inverse;
  if (!(std::abs(scaled) < static_cast<float>(k_voxel_range))) return -1;
  const auto toward_zero = static_cast<std::int32_t>(scaled);
  const int below = scaled < static_cast<float>(toward_zero) ? 1 : 0;
  return toward_zero - below + k_voxel_range;
}

// Load factor of the hash table: at most one half.
int slot_bits_for(int voxels) {
  int bits = 1;
  while ((1 << bits) < 2 * voxels) ++bits;
  return bits;
}

constexpr int k_axis_bits = 21;
static_assert(2 * k_voxel_range == 1 << k_axis_bits);

}  // namespace

std::size_t VoxelGrid::bytes(int voxels) noexcept {
  return Column<Voxel>::bytes(voxels) + Column<std::int32_t>::bytes(1 << slot_bits_for(voxels));
}

Reason VoxelGrid::prepare(const VoxelGridSettings& settings, int voxels, Arena& arena) noexcept {
  capacity_ = count_ = 0;
  dropped_ = out_of_range_ = probes_ = 0;
  if (voxels < 1 || voxels > k_cloud_points_max) return Reason::out_of_range;
  if (!(settings.voxel_m > 0 && std::isfinite(1 / settings.voxel_m))) return Reason::out_of_range;
  slots_bits_ = slot_bits_for(voxels);
  if (!voxels_.reserve(voxels, arena) || !slots_.reserve(1 << slots_bits_, arena)) {
    return Reason::not_prepared;
  }
  inverse_ = 1 / settings.voxel_m;
  capacity_ = voxels;
  return Reason::none;
}

void VoxelGrid::clear() noexcept {
  for (int i = 0; i < count_; ++i) slots_[voxels_[i].slot] = 0;
  count_ = 0;
  dropped_ = out_of_range_ = 0;
}

int VoxelGrid::find_or_add(std::uint64_t key) noexcept {
  const std::uint64_t mask = (std::uint64_t{1} << slots_bits_) - 1;
  std::uint64_t slot = (key * 0x9E3779B97F4A7C15u) >> (64 - slots_bits_);
  for (int probe = 0; probe < k_voxel_probes_max; ++probe, slot = (slot + 1) & mask) {
    const auto at = static_cast<int>(slot);
    ++probes_;
    const std::int32_t found = slots_[at];
    if (found == 0) {
      if (count_ == capacity_) return -1;
      voxels_[count_] = {key, 0, 0, 0, 0, at};
      slots_[at] = ++count_;
      return count_ - 1;
    }
    if (voxels_[found - 1].key == key) return found - 1;
  }
  return -1;
}

int VoxelGrid::add(const PointCloud& points, int from, int most) noexcept {
  const int end = std::min(points.count, from + std::max(most, 0));
  if (capacity_ == 0) return end;
  // Neighbouring pixels of a depth image mostly share a voxel.
  std::uint64_t last_key = ~std::uint64_t{0};
  int voxel = -1;
  for (int i = from; i < end; ++i) {
    const std::int64_t x = place_of(points.x[i], inverse_);
    const std::int64_t y = place_of(points.y[i], inverse_);
    const std::int64_t z = place_of(points.z[i], inverse_);
    if ((x | y | z) < 0) {
      ++out_of_range_;
      continue;
    }
    const auto key = static_cast<std::uint64_t>((z << k_axis_bits | y) << k_axis_bits | x);
    if (key != last_key) {
      voxel = find_or_add(key);
      last_key = key;
    }
    if (voxel < 0) {
      ++dropped_;
      continue;
    }
    Voxel& sum = voxels_[voxel];
    sum.x += static_cast<double>(points.x[i]);
    sum.y += static_cast<double>(points.y[i]);
    sum.z += static_cast<double>(points.z[i]);
    ++sum.points;
  }
  return end;
}

int VoxelGrid::write(int from, int most, PointCloud& to) const noexcept {
  const int end = std::min(count_, from + std::max(most, 0));
  for (int i = from; i < end; ++i) {
    const Voxel& sum = voxels_[i];
    const auto n = static_cast<double>(sum.points);
    if (!to.add(static_cast<float>(sum.x / n), static_cast<float>(sum.y / n),
                static_cast<float>(sum.z / n), static_cast<float>(sum.points))) {
      return i;
    }
  }
  return end;
}

Reason VoxelGrid::reason() const noexcept {
  if (capacity_ == 0) return Reason::not_prepared;
  return dropped_ > 0 ? Reason::cloud_full : Reason::none;
}

}  // namespace glint
