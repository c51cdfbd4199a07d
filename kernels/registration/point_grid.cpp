#include "kernels/registration/point_grid.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace glint {
namespace {

constexpr int k_cells_reach = 2;          // cells searched on each side
constexpr float k_coordinate_max = 1e4f;  // metres; larger coordinates have no cell

constexpr std::uint64_t mixed(std::uint64_t x) noexcept {  // SplitMix64's finalizer
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return x ^ (x >> 31);
}

// The 125 cells around one, nearest first: a search skips cells farther than its best point.
struct Offset {
  std::int8_t x, y, z;
  float
      distance_min_cells;  // in cells: lower bound of the distance between points of the two cells
};
constexpr int k_offsets = 125;
constexpr std::array<Offset, k_offsets> offsets() {
  std::array<Offset, k_offsets> list{};
  int n = 0;
  for (int squares = 0; squares <= 12; ++squares) {
    for (int x = -2; x <= 2; ++x) {
      for (int y = -2; y <= 2; ++y) {
        for (int z = -2; z <= 2; ++z) {
          if (x * x + y * y + z * z != squares) continue;
          // Uses only the widest gap along one axis: 0 for neighbours, one cell for the others.
          const bool far = x * x == 4 || y * y == 4 || z * z == 4;
          list[static_cast<std::size_t>(n++)] = {static_cast<std::int8_t>(x),
                                                 static_cast<std::int8_t>(y),
                                                 static_cast<std::int8_t>(z), far ? 1.0f : 0.0f};
        }
      }
    }
  }
  return list;
}
constexpr std::array<Offset, k_offsets> k_order = offsets();

bool has_cell(const Vector3f& p) noexcept {
  return std::abs(p.x()) < k_coordinate_max && std::abs(p.y()) < k_coordinate_max &&
         std::abs(p.z()) < k_coordinate_max;  // false for NaN
}

}  // namespace

Reason PointGrid::prepare(int points_max) {
  if (points_max < 1) return Reason::out_of_range;
  const auto points = static_cast<std::size_t>(points_max);
  cells_.assign(std::bit_ceil(2 * points), Cell{});
  entries_.resize(points);
  slot_of_.resize(points);
  count_ = 0;
  return Reason::none;
}

std::uint64_t PointGrid::key_of(const Eigen::Vector3i& cell) const noexcept {
  const auto part = [](int v) { return static_cast<std::uint64_t>(v + (1 << 20)) & 0x1FFFFF; };
  return (std::uint64_t{1} << 63) | part(cell.x()) << 42 | part(cell.y()) << 21 | part(cell.z());
}

Eigen::Vector3i PointGrid::cell_of(const Vector3f& point) const noexcept {
  const float limit = 1 << 19;
  const auto part = [&](float v) {
    return static_cast<int>(std::clamp(std::floor(v / cell_m_), -limit, limit));
  };
  return {part(point.x()), part(point.y()), part(point.z())};
}

const PointGrid::Cell* PointGrid::find(std::uint64_t key, int& probes) const noexcept {
  const std::size_t mask = cells_.size() - 1;
  std::size_t at = mixed(key) & mask;
  for (int probe = 0; probe < k_grid_probes_max; ++probe) {
    ++probes;
    if (cells_[at].key == key) return &cells_[at];
    if (cells_[at].key == 0) return nullptr;
    at = (at + 1) & mask;
  }
  return nullptr;
}

Reason PointGrid::begin_build(std::span<const Vector3f> points, double reach_m) noexcept {
  phase_ = Phase::done;
  if (points.size() > slot_of_.size()) return Reason::not_prepared;
  if (!(reach_m > 0) || !(reach_m < 1e3)) return Reason::out_of_range;
  reach_m_ = static_cast<float>(reach_m);
  cell_m_ = reach_m_ / k_cells_reach;
  points_ = points;
  count_ = at_ = 0;
  begin_ = 0;
  phase_ = Phase::clear;
  return Reason::none;
}

Reason PointGrid::build(std::span<const Vector3f> points, double reach_m) noexcept {
  const Reason reason = begin_build(points, reach_m);
  StepBudget all;
  while (!build_step(all)) all = StepBudget();
  return reason;
}

void PointGrid::insert(std::size_t i) noexcept {
  slot_of_[i] = -1;
  probes_ = 0;
  if (!has_cell(points_[i])) return;
  const std::size_t mask = cells_.size() - 1;
  const std::uint64_t key = key_of(cell_of(points_[i]));
  std::size_t at = mixed(key) & mask;
  for (; probes_ < k_grid_probes_max; ++probes_, at = (at + 1) & mask) {
    if (cells_[at].key != 0 && cells_[at].key != key) continue;
    cells_[at].key = key;
    ++cells_[at].end;
    slot_of_[i] = static_cast<std::int32_t>(at);
    break;
  }
}

bool PointGrid::build_step(StepBudget& budget) noexcept {
  const auto cells = static_cast<int>(cells_.size()), points = static_cast<int>(points_.size());
  if (phase_ == Phase::clear) {
    const int end = budget.take_items(at_, cells, k_grid_clear_steps);
    std::fill(cells_.begin() + at_, cells_.begin() + end, Cell{});
    at_ = end;
    if (at_ < cells) return false;
    at_ = 0;
    phase_ = Phase::insert;
  } else if (phase_ == Phase::insert) {
    for (; at_ < points && !budget.spent(); ++at_) {
      insert(static_cast<std::size_t>(at_));
      budget.take(k_grid_insert_steps + probes_ * k_grid_probe_steps);
    }
    if (at_ < points) return false;
    at_ = 0;
    phase_ = Phase::sum;
  } else if (phase_ == Phase::sum) {
    for (const int end = budget.take_items(at_, cells, k_grid_sum_steps); at_ < end; ++at_) {
      Cell& cell = cells_[static_cast<std::size_t>(at_)];
      const std::int32_t size = cell.end;
      cell.begin = cell.end = begin_;
      begin_ += size;
    }
    if (at_ < cells) return false;
    at_ = 0;
    phase_ = Phase::place;
  } else if (phase_ == Phase::place) {
    for (const int end = budget.take_items(at_, points, k_grid_scatter_steps); at_ < end; ++at_) {
      const auto i = static_cast<std::size_t>(at_);
      if (slot_of_[i] < 0) continue;
      Cell& cell = cells_[static_cast<std::size_t>(slot_of_[i])];
      entries_[static_cast<std::size_t>(cell.end++)] = {points_[i], at_};
      ++count_;
    }
    if (at_ == points) phase_ = Phase::done;
  }
  return phase_ == Phase::done;
}

Nearest PointGrid::nearest(const Vector3f& point, float radius_m) const noexcept {
  StepBudget all;
  return nearest(point, radius_m, all);
}

Nearest PointGrid::nearest(const Vector3f& point, float radius_m,
                           StepBudget& budget) const noexcept {
  Nearest best;
  best.square_m2 = radius_m * radius_m;
  if (count_ == 0 || !has_cell(point)) return best;
  const Eigen::Vector3i middle = cell_of(point);
  int left = k_grid_points_compared_max;
  for (const Offset& offset : k_order) {
    const float least = offset.distance_min_cells * cell_m_;
    if (least * least > best.square_m2) continue;
    int probes = 0;
    const Cell* cell = find(key_of(middle + Eigen::Vector3i(offset.x, offset.y, offset.z)), probes);
    budget.take(k_grid_find_steps + probes * k_grid_probe_steps);
    if (cell == nullptr) continue;
    for (std::int32_t i = cell->begin; i < cell->end && left > 0; ++i, --left) {
      const Entry& entry = entries_[static_cast<std::size_t>(i)];
      const float square = (entry.point - point).squaredNorm();
      const bool nearer = square < best.square_m2 ||
                          (square == best.square_m2 && best.index >= 0 && entry.index < best.index);
      if (nearer) {
        best.square_m2 = square;
        best.index = entry.index;
      }
    }
  }
  budget.take((k_grid_points_compared_max - left) * k_grid_point_steps);
  return best;
}

}  // namespace glint
