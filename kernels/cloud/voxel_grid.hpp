// Voxel grid filter: the mean point of each voxel, accumulated over frames; uniform density at any
// distance.
//
// What:     adds points frame by frame. Each voxel of a grid fixed to the world keeps the running
//           sum of its points; its output point is their mean.
// Cost:     linear in the points added; at most k_voxel_probes_max hash slots for each.
// Worst:    voxels whose keys hash to the same slots. Counts and discards points that are not
//           finite or beyond the grid. When full, existing voxels still accumulate points; points
//           in new voxels are counted and discarded.
// Accuracy: sums in double, in the order of addition: within 1e-15 m of the points' mean, then
//           rounded to float. A point's voxel is that of its float coordinates.
// Source:   open addressing with linear probing: Knuth, "The Art of Computer Programming", vol. 3,
//           section 6.4, algorithm L; multiplicative hashing, ibid.
#pragma once

#include <cstdint>

#include "kernels/cloud/point_cloud.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr int k_voxel_probes_max = 64;
// Number of voxels from the origin to the end of the grid along each axis, in either direction.
inline constexpr int k_voxel_range = 1 << 20;

struct VoxelGridSettings {
  float voxel_m = 0.01f;
};

class VoxelGrid {
 public:
  // Bytes that prepare() takes from an arena for 1 to k_cloud_points_max voxels.
  [[nodiscard]] static std::size_t bytes(int voxels) noexcept;
  // Reason: none; out_of_range (voxels, voxel_m); not_prepared (too little left in the arena).
  [[nodiscard]] Reason prepare(const VoxelGridSettings& settings, int voxels,
                               Arena& arena) noexcept;

  // Discards all voxels; linear in their number.
  void clear() noexcept GLINT_NONBLOCKING;

  // Adds points [from, from + most) of the cloud; returns the first one not yet added.
  int add(const PointCloud& points, int from, int most) noexcept GLINT_NONBLOCKING;

  // Appends voxels [from, from + most) to the cloud, in the order of their first points; returns
  // the first one not yet written. Stops when the cloud is full.
  int write(int from, int most, PointCloud& to) const noexcept GLINT_NONBLOCKING;

  [[nodiscard]] int count() const noexcept { return count_; }
  // Hash slots probed since prepare().
  [[nodiscard]] std::int64_t probes() const noexcept { return probes_; }
  // Discarded points: no slot for a new voxel; beyond the grid or not finite.
  [[nodiscard]] std::int64_t dropped() const noexcept { return dropped_; }
  [[nodiscard]] std::int64_t out_of_range() const noexcept { return out_of_range_; }
  // none; cloud_full (a point was dropped); not_prepared.
  [[nodiscard]] Reason reason() const noexcept;

 private:
  struct Voxel {
    std::uint64_t key;
    double x, y, z;
    std::int32_t points;
    std::int32_t slot;
  };
  [[nodiscard]] int find_or_add(std::uint64_t key) noexcept;

  float inverse_ = 0;
  Column<Voxel> voxels_;
  Column<std::int32_t> slots_;  // 1 + a voxel's index, or 0
  int slots_bits_ = 0;
  int capacity_ = 0, count_ = 0;
  std::int64_t dropped_ = 0, out_of_range_ = 0, probes_ = 0;
};

}  // namespace glint
