// One point for each small cube of space that was seen: uniform density, whatever the distance.
//
// What:     frames of points are added as they come; each voxel of a grid that is fixed to the
//           world keeps the running sum of its points, and their mean is its point.
// Cost:     linear in the points added; at most k_voxel_probes_max slots are looked at for each.
// Worst:    points whose voxels' keys fall on the same slots; points beyond the grid or not finite
//           are counted and left out. Full: voxels that came first stay and go on growing, points
//           in new ones are counted and left out.
// Accuracy: sums in double, in the order of coming: the mean to 1e-15 m of its points' mean, then
//           rounded to float. A point's voxel is that of its float coordinates.
// Source:   open addressing with linear probing: Knuth, "The Art of Computer Programming", vol. 3,
//           section 6.4, algorithm L; multiplicative hashing, ibid.
#pragma once

#include <cstdint>

#include "kernels/cloud/point_cloud.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr int k_voxel_probes_max = 64;
// Voxels from the origin to the end of the grid along each axis, in either direction.
inline constexpr int k_voxel_range = 1 << 20;

struct VoxelGridSettings {
  float voxel_m = 0.01f;
};

class VoxelGrid {
 public:
  // What prepare() takes of an arena for 1 to k_cloud_points_max voxels.
  [[nodiscard]] static std::size_t bytes(int voxels) noexcept;
  // Reason: none; out_of_range (voxels, voxel_m); not_prepared (the arena has not enough left).
  [[nodiscard]] Reason prepare(const VoxelGridSettings& settings, int voxels,
                               Arena& arena) noexcept;

  // Forgets all voxels; takes time for each that there was.
  void clear() noexcept GLINT_NONBLOCKING;

  // Adds points [from, from + most) of the cloud; gives the first one not yet added.
  int add(const PointCloud& points, int from, int most) noexcept GLINT_NONBLOCKING;

  // Writes voxels [from, from + most) to the cloud, from its end on, in the order of their first
  // points; gives the first one not yet written. Stops where the cloud is full.
  int write(int from, int most, PointCloud& to) const noexcept GLINT_NONBLOCKING;

  [[nodiscard]] int count() const noexcept { return count_; }
  // Slots looked at since prepare().
  [[nodiscard]] std::int64_t probes() const noexcept { return probes_; }
  // Points left out: without a place for a new voxel; beyond the grid or not finite.
  [[nodiscard]] std::int64_t dropped() const noexcept { return dropped_; }
  [[nodiscard]] std::int64_t out_of_range() const noexcept { return out_of_range_; }
  // none; cloud_full where a point was dropped; not_prepared.
  [[nodiscard]] Reason reason() const noexcept;

 private:
  struct Voxel {
    std::uint64_t key;
    double x, y, z;
    std::int32_t points;
    std::int32_t slot;
  };
  [[nodiscard]] int find_or_add(std::uint64_t key) noexcept;

  VoxelGridSettings settings_;
  float inverse_ = 0;
  Column<Voxel> voxels_;
  Column<std::int32_t> slots_;  // 1 + a voxel's index, or 0
  int slots_bits_ = 0;
  int capacity_ = 0, count_ = 0;
  std::int64_t dropped_ = 0, out_of_range_ = 0, probes_ = 0;
};

}  // namespace glint
