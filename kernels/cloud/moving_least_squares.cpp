#include "kernels/cloud/moving_least_squares.hpp"

#include <algorithm>
#include <cmath>

namespace glint {

Reason MovingLeastSquares::prepare(const MovingLeastSquaresSettings& settings, int points,
                                   Arena& arena) noexcept {
  prepared_ = false;
  if (!(settings.radius_m > 0 && std::isfinite(1 / settings.radius_m)) ||
      settings.candidates_max < 1 || settings.candidates_max > k_cloud_points_max) {
    return Reason::out_of_range;
  }
  settings_ = settings;
  const Reason reason = grid_.prepare(points, arena);
  if (reason != Reason::none) return reason;
  for (Column<float>* column :
       {&x_, &y_, &z_, &weight_, &near_x_, &near_y_, &near_z_, &near_weight_}) {
    if (!column->reserve(settings.candidates_max + k_four_padding, arena)) {
      return Reason::not_prepared;
    }
  }
  if (!sources_.reserve(points, arena)) return Reason::not_prepared;
  near_ = {near_x_.data(), near_y_.data(), near_z_.data(), near_weight_.data(), 0};
  prepared_ = true;
  return Reason::none;
}

void MovingLeastSquares::begin(const PointCloud& points) noexcept {
  if (!prepared_) return;
  cloud_ = &points;
  grid_.begin(points, settings_.radius_m);
  walk_.begin();
  appended_ = dropped_ = isolated_ = on_plane_ = candidates_exceeded_ = 0;
}

// All points of a cell have the same candidates: gathered once per cell.
void MovingLeastSquares::gather_candidates() noexcept {
  candidates_ = 0;
  cell_cut_ = false;
  for (const NeighbourSweep::Row& row : walk_.rows()) {
    const int room = settings_.candidates_max - candidates_;
    const int taken = std::min(row.end - row.begin, room);
    cell_cut_ = cell_cut_ || taken < row.end - row.begin;
    std::copy_n(grid_.x() + row.begin, taken, x_.data() + candidates_);
    std::copy_n(grid_.y() + row.begin, taken, y_.data() + candidates_);
    std::copy_n(grid_.z() + row.begin, taken, z_.data() + candidates_);
    for (int i = 0; i < taken; ++i) {
      const bool equal = settings_.weights == NeighbourWeights::equal;
      weight_[candidates_ + i] = equal ? 1 : cloud_->weight[grid_.index_in_cloud(row.begin + i)];
    }
    candidates_ += taken;
  }
}

// Branch-free compaction: writes every candidate; the next one overwrites it if it is too far.
void MovingLeastSquares::gather_neighbours(int point) noexcept {
  const float x = grid_.x()[point], y = grid_.y()[point], z = grid_.z()[point];
  const float limit = settings_.radius_m * settings_.radius_m;
  int near = 0;
  for (int i = 0; i < candidates_; ++i) {
    const float dx = x_[i] - x, dy = y_[i] - y, dz = z_[i] - z;
    near_.x[near] = dx, near_.y[near] = dy, near_.z[near] = dz;
    near_.weight[near] = weight_[i];
    near += (dx * dx + dy * dy) + dz * dz <= limit ? 1 : 0;
  }
  near_.count = near;
}

// Returns the steps taken.
int MovingLeastSquares::smooth(int point, PointCloud& smoothed) noexcept {
  gather_neighbours(point);
  candidates_exceeded_ += cell_cut_ ? 1 : 0;
  if (near_.count < k_plane_neighbours_min) {
    ++isolated_;
    return k_surface_steps + k_near_steps * candidates_;
  }
  const int steps = k_surface_steps + k_near_steps * candidates_ + k_neighbour_steps * near_.count;
  const SurfacePoint surface = local_surface(near_, settings_.radius_m);
  on_plane_ += surface.on_polynomial ? 0 : 1;
  const auto moved = [](float from, double by) {
    return static_cast<float>(static_cast<double>(from) + by);
  };
  const int at = smoothed.count;
  const float weight = cloud_->weight[grid_.index_in_cloud(point)];
  if (!smoothed.add(moved(grid_.x()[point], surface.offset_m.x()),
                    moved(grid_.y()[point], surface.offset_m.y()),
                    moved(grid_.z()[point], surface.offset_m.z()), weight)) {
    ++dropped_;
    return steps;
  }
  sources_[appended_++] = grid_.index_in_cloud(point);
  smoothed.normal_x[at] = static_cast<float>(surface.normal.x());
  smoothed.normal_y[at] = static_cast<float>(surface.normal.y());
  smoothed.normal_z[at] = static_cast<float>(surface.normal.z());
  return steps;
}

bool MovingLeastSquares::step(SliceSize most, PointCloud& smoothed) noexcept {
  if (!prepared_) return true;
  return walk_.step(
      grid_, most,
      [&] {
        gather_candidates();
        return k_gather_steps * candidates_;
      },
      [&](int point) { return smooth(point, smoothed); });
}

Reason MovingLeastSquares::reason() const noexcept {
  if (!prepared_) return Reason::not_prepared;
  if (dropped() > 0) return Reason::cloud_full;
  return candidates_exceeded_ > 0 ? Reason::search_full : Reason::none;
}

}  // namespace glint
