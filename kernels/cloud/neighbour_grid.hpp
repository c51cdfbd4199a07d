// Uniform grid for fixed-radius neighbour search: points sorted by cell.
//
// What:     cells as wide as the search radius; points sorted by cell, x fastest. Three cells along
//           x are then one range of the sorted columns, and nine ranges contain every point within
//           the radius. NeighbourSweep finds the ranges for one cell after another.
// Cost:     radix sort in four passes over the points, data independent; for a cell 18 searches of
//           at most k_row_search_max steps, usually one or two, because cells come in ascending
//           order.
// Worst:    counts and discards points that are not finite or beyond the grid (k_grid_cells_half
//           cells from the origin along an axis). A full grid keeps the cloud's first points.
// Accuracy: exact: copies coordinates; points of equal cells keep the cloud's order.
// Source:   counting sort by digits: Knuth, "The Art of Computer Programming", vol. 3, section
//           5.2.5, algorithm R.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/cloud/four_floats.hpp"
#include "kernels/cloud/point_cloud.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr int k_grid_axis_bits = 10;
// One cell at each end stays empty, so that a row never continues in the next.
inline constexpr int k_grid_cells_half = (1 << (k_grid_axis_bits - 1)) - 1;
inline constexpr int k_cell_rows = 9;
inline constexpr int k_row_search_max = 33;  // 8 linear steps, then 25 bisections

class NeighbourGrid {
  struct Keyed {
    std::uint32_t key;
    std::int32_t index;
  };

 public:
  [[nodiscard]] static constexpr std::size_t bytes(int points) noexcept {
    return 2 * Column<Keyed>::bytes(points) + 3 * Column<float>::bytes(points + k_four_padding) +
           3 * Column<std::int32_t>::bytes(points + 1);
  }
  // Reason: none; out_of_range (points); not_prepared (less than bytes(points) left in the arena).
  [[nodiscard]] Reason prepare(int points, Arena& arena) noexcept;

  // Starts to sort a cloud. It must not change until sorted() returns true.
  void begin(const PointCloud& points, float cell_m) noexcept GLINT_NONBLOCKING;
  // Processes at most `most` points.
  void sort(int most) noexcept GLINT_NONBLOCKING;
  // Points left in the current pass.
  [[nodiscard]] int left_in_pass() const noexcept {
    return sorted() ? 0 : (phase_ == 0 ? cloud_->count : count_) - at_;
  }
  [[nodiscard]] bool keyed() const noexcept { return phase_ > 0; }
  [[nodiscard]] bool sorted() const noexcept { return phase_ == 5; }

  [[nodiscard]] int count() const noexcept { return count_; }
  [[nodiscard]] int cells() const noexcept { return cells_; }
  // Points not in the grid: beyond it or not finite; beyond its capacity.
  [[nodiscard]] int out_of_range() const noexcept { return out_of_range_; }
  [[nodiscard]] int dropped() const noexcept { return dropped_; }

  // Sorted columns, readable k_four_padding beyond the end, and each point's index in the cloud.
  [[nodiscard]] const float* x() const noexcept { return x_.data(); }
  [[nodiscard]] const float* y() const noexcept { return y_.data(); }
  [[nodiscard]] const float* z() const noexcept { return z_.data(); }
  [[nodiscard]] int index_in_cloud(int i) const noexcept { return cloud_index_[i]; }
  // First point of a cell; for cells() the number of points.
  [[nodiscard]] int first_point(int cell) const noexcept { return first_[cell]; }
  [[nodiscard]] std::uint32_t key(int cell) const noexcept { return cell_key_[cell]; }

  static constexpr std::uint32_t k_step_y = 1u << k_grid_axis_bits;
  static constexpr std::uint32_t k_step_z = 1u << (2 * k_grid_axis_bits);

 private:
  void key_points(int end) noexcept;
  void move_points(int end) noexcept;
  void copy_points(int end) noexcept;
  void next_phase() noexcept;

  static constexpr int k_digits = 3;
  const PointCloud* cloud_ = nullptr;
  float inverse_ = 0;
  int capacity_ = 0, count_ = 0, cells_ = 0, out_of_range_ = 0, dropped_ = 0;
  int phase_ = 0, at_ = 0;  // 0: keys; 1 to 3: a digit each; 4: columns and cells; 5: done
  std::array<std::array<std::int32_t, 1 << k_grid_axis_bits>, k_digits> digits_{};
  Column<Keyed> keyed_, spare_;
  Column<float> x_, y_, z_;
  Column<std::int32_t> cloud_index_, first_;
  Column<std::uint32_t> cell_key_;
};

// Point ranges around one cell after another, in ascending order. Row 0 contains the cell itself.
class NeighbourSweep {
 public:
  struct Row {
    int begin = 0, end = 0;  // sorted points
  };
  using Rows = std::array<Row, k_cell_rows>;

  void begin() noexcept { cells_begin_ = cells_end_ = {}; }
  // `cell` must not decrease from call to call. Returns the number of cells compared.
  int rows_around(const NeighbourGrid& grid, int cell, Rows& rows) noexcept GLINT_NONBLOCKING;

 private:
  std::array<int, k_cell_rows> cells_begin_{}, cells_end_{};
};

}  // namespace glint
