#include "kernels/cloud/plane_support.hpp"

#include <algorithm>
#include <cmath>

namespace glint {

Reason PlaneSupport::prepare(const PlaneSupportSettings& settings, int points,
                             Arena& arena) noexcept {
  prepared_ = false;
  if (!(settings.radius_m > 0 && std::isfinite(1 / settings.radius_m)) ||
      !(settings.part_min >= 0 && settings.part_min <= 1) || settings.candidates_max < 1) {
    return Reason::out_of_range;
  }
  settings_ = settings;
  const Reason reason = grid_.prepare(points, arena);
  if (reason != Reason::none) return reason;
  if (!plane_of_.reserve(points, arena)) return Reason::not_prepared;
  capacity_ = points;
  points_ = 0;
  prepared_ = true;
  return Reason::none;
}

void PlaneSupport::begin(const PointCloud& points, const PlaneSearch& planes) noexcept {
  if (!prepared_) return;
  planes_ = &planes;
  points_ = std::min(points.count, capacity_);
  std::fill_n(plane_of_.data(), points_, PlaneSearch::k_no_plane);
  grid_.begin(points, settings_.radius_m);
  walk_.begin();
  taken_off_ = 0;
}

bool PlaneSupport::is_supported(int point, std::uint8_t plane) const noexcept {
  const float x = grid_.x()[point], y = grid_.y()[point], z = grid_.z()[point];
  const float limit = settings_.radius_m * settings_.radius_m;
  int near = 0, on_plane = 0, left = settings_.candidates_max;
  for (const NeighbourSweep::Row& row : walk_.rows()) {
    const int end = std::min(row.end, row.begin + left);
    left -= std::max(end - row.begin, 0);
    for (int i = row.begin; i < end; ++i) {
      const float dx = grid_.x()[i] - x, dy = grid_.y()[i] - y, dz = grid_.z()[i] - z;
      if ((dx * dx + dy * dy) + dz * dz > limit) continue;
      ++near;
      on_plane += planes_->plane_of(grid_.place_in_cloud(i)) == plane ? 1 : 0;
    }
  }
  return static_cast<float>(on_plane) >= settings_.part_min * static_cast<float>(near);
}

bool PlaneSupport::step(int most) noexcept {
  if (!prepared_) return true;
  return walk_.step(
      grid_, most, [] {},
      [&](int point) {
        const int place = grid_.place_in_cloud(point);
        const std::uint8_t plane = planes_->plane_of(place);
        const bool stays = plane == PlaneSearch::k_no_plane || is_supported(point, plane);
        plane_of_[place] = stays ? plane : PlaneSearch::k_no_plane;
        taken_off_ += stays ? 0 : 1;
      });
}

}  // namespace glint
