#include "kernels/cloud/neighbour_grid.hpp"

#include <cmath>
#include <utility>

namespace glint {
namespace {

constexpr std::uint32_t k_no_key = ~std::uint32_t{0};
constexpr std::uint32_t k_digit_mask = (1u << k_grid_axis_bits) - 1;

// Cell index along one axis, from 1; 0 outside the grid.
std::uint32_t cell_along(float coordinate, float inverse) {
  const float scaled = coordinate * inverse;
  if (!(std::abs(scaled) < static_cast<float>(k_grid_cells_half))) return 0;
  const auto toward_zero = static_cast<std::int32_t>(scaled);
  const int below = scaled < static_cast<float>(toward_zero) ? 1 : 0;
  return static_cast<std::uint32_t>(toward_zero - below + k_grid_cells_half + 1);
}

std::uint32_t key_of(float x, float y, float z, float inverse) {
  const std::uint32_t cx = cell_along(x, inverse), cy = cell_along(y, inverse),
                      cz = cell_along(z, inverse);
  if (cx == 0 || cy == 0 || cz == 0) return k_no_key;
  return (cz << k_grid_axis_bits | cy) << k_grid_axis_bits | cx;
}

// First cell from `from` on whose key is at least `least`: eight linear steps, then bisection.
int first_at_least(const NeighbourGrid& grid, int from, std::uint32_t least, int& compared) {
  for (int step = 0; step < 8; ++step, ++from) {
    ++compared;
    if (from == grid.cells() || grid.key(from) >= least) return from;
  }
  int low = from, high = grid.cells();
  while (low < high) {
    const int middle = low + (high - low) / 2;
    ++compared;
    if (grid.key(middle) < least) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

}  // namespace

Reason NeighbourGrid::prepare(int points, Arena& arena) noexcept {
  capacity_ = count_ = cells_ = 0;
  phase_ = 5;
  if (points < 1 || points > k_cloud_points_max) return Reason::out_of_range;
  for (Column<float>* column : {&x_, &y_, &z_}) {
    if (!column->reserve(points + k_four_padding, arena)) return Reason::not_prepared;
  }
  if (!keyed_.reserve(points, arena) || !spare_.reserve(points, arena) ||
      !cloud_index_.reserve(points, arena) || !first_.reserve(points + 1, arena) ||
      !cell_key_.reserve(points, arena)) {
    return Reason::not_prepared;
  }
  capacity_ = points;
  return Reason::none;
}

void NeighbourGrid::begin(const PointCloud& points, float cell_m) noexcept {
  cloud_ = &points;
  inverse_ = 1 / cell_m;
  count_ = cells_ = out_of_range_ = dropped_ = 0;
  phase_ = at_ = 0;
  for (auto& digit : digits_) digit.fill(0);
}

void NeighbourGrid::sort(int most) noexcept {
  if (sorted()) return;
  const int all = phase_ == 0 ? cloud_->count : count_;
  const int end = std::min(all, at_ + std::max(most, 1));
  if (phase_ == 0) {
    key_points(end);
  } else if (phase_ <= k_digits) {
    move_points(end);
  } else {
    copy_points(end);
  }
  at_ = end;
  if (end == all) next_phase();
}

void NeighbourGrid::next_phase() noexcept {
  at_ = 0;
  if (phase_ == 0) {
    for (auto& digit : digits_) {
      std::int32_t before = 0;
      for (std::int32_t& begin_of_digit : digit) before += std::exchange(begin_of_digit, before);
    }
  } else if (phase_ <= k_digits) {
    std::swap(keyed_, spare_);
  } else {
    first_[cells_] = count_;
  }
  ++phase_;
}

void NeighbourGrid::key_points(int end) noexcept {
  for (int i = at_; i < end; ++i) {
    const std::uint32_t key = key_of(cloud_->x[i], cloud_->y[i], cloud_->z[i], inverse_);
    if (key == k_no_key) {
      ++out_of_range_;
      continue;
    }
    if (count_ == capacity_) {
      ++dropped_;
      continue;
    }
    keyed_[count_++] = {key, i};
    for (std::size_t d = 0; d < k_digits; ++d) {
      ++digits_[d][key >> (d * k_grid_axis_bits) & k_digit_mask];
    }
  }
}

void NeighbourGrid::move_points(int end) noexcept {
  const auto d = static_cast<std::size_t>(phase_ - 1);
  for (int i = at_; i < end; ++i) {
    const Keyed point = keyed_[i];
    spare_[digits_[d][point.key >> (d * k_grid_axis_bits) & k_digit_mask]++] = point;
  }
}

void NeighbourGrid::copy_points(int end) noexcept {
  for (int i = at_; i < end; ++i) {
    const Keyed point = keyed_[i];
    x_[i] = cloud_->x[point.index];
    y_[i] = cloud_->y[point.index];
    z_[i] = cloud_->z[point.index];
    cloud_index_[i] = point.index;
    if (cells_ == 0 || cell_key_[cells_ - 1] != point.key) {
      cell_key_[cells_] = point.key;
      first_[cells_++] = i;
    }
  }
}

int NeighbourSweep::rows_around(const NeighbourGrid& grid, int cell, Rows& rows) noexcept {
  int compared = 0;
  constexpr auto y = static_cast<std::int64_t>(NeighbourGrid::k_step_y);
  constexpr auto z = static_cast<std::int64_t>(NeighbourGrid::k_step_z);
  constexpr std::array<std::int64_t, k_cell_rows> steps{0, -z - y, -z, -z + y, -y,
                                                        y, z - y,  z,  z + y};
  const std::int64_t key = grid.key(cell);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    // Cell indices start at 1 on every axis, so that none of these is below 0.
    const auto least = static_cast<std::uint32_t>(key + steps[i] - 1);
    cells_begin_[i] = first_at_least(grid, cells_begin_[i], least, compared);
    cells_end_[i] =
        first_at_least(grid, std::max(cells_end_[i], cells_begin_[i]), least + 3, compared);
    rows[i] = {grid.first_point(cells_begin_[i]), grid.first_point(cells_end_[i])};
  }
  return compared;
}

}  // namespace glint
