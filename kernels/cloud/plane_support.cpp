#include "kernels/cloud/plane_support.hpp"

#include <algorithm>
#include <cmath>

namespace glint {

Reason PlaneSupport::prepare(const PlaneSupportSettings& settings, int points,
                             Arena& arena) noexcept {
  prepared_ = false;
  if (!(settings.radius_m > 0 && std::isfinite(1 / settings.radius_m)) ||
      !(settings.support_share_min >= 0 && settings.support_share_min <= 1) ||
      settings.candidates_max < 1) {
    return Reason::out_of_range;
  }
  settings_ = settings;
  const Reason reason = grid_.prepare(points, arena);
  if (reason != Reason::none) return reason;
  if (!plane_of_.reserve(points, arena)) return Reason::not_prepared;
  capacity_ = points;
  points_ = marked_ = 0;
  prepared_ = true;
  return Reason::none;
}

void PlaneSupport::begin(const PointCloud& points, const PlaneSearch& planes) noexcept {
  if (!prepared_) return;
  planes_ = &planes;
  points_ = std::min(points.count, capacity_);
  marked_ = 0;
  grid_.begin(points, settings_.radius_m);
  walk_.begin();
  removed_ = 0;
}

bool PlaneSupport::is_supported(int point, std::uint8_t plane) noexcept {
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
      on_plane += planes_->plane_of(grid_.index_in_cloud(i)) == plane ? 1 : 0;
    }
  }
  compared_ = settings_.candidates_max - left;
  return static_cast<float>(on_plane) >= settings_.support_share_min * static_cast<float>(near);
}

bool PlaneSupport::step(SliceSize most) noexcept {
  steps_ = 0;
  if (!prepared_) return true;
  if (marked_ < points_) {
    const std::int64_t wanted = std::min<std::int64_t>(
        most.items, std::max<std::int64_t>(1, most.steps) * k_marked_per_step);
    const auto marked = static_cast<int>(std::min<std::int64_t>(points_ - marked_, wanted));
    std::fill_n(plane_of_.data() + marked_, marked, PlaneSearch::k_no_plane);
    marked_ += marked;
    steps_ = 1 + marked / k_marked_per_step;
    return false;
  }
  const bool done = walk_.step(
      grid_, most, [] { return 0; },
      [&](int point) {
        const int place = grid_.index_in_cloud(point);
        const std::uint8_t plane = planes_->plane_of(place);
        compared_ = 0;
        const bool stays = plane == PlaneSearch::k_no_plane || is_supported(point, plane);
        plane_of_[place] = stays ? plane : PlaneSearch::k_no_plane;
        removed_ += stays ? 0 : 1;
        return k_support_steps + k_vote_steps * compared_;
      });
  steps_ = walk_.steps();
  return done;
}

}  // namespace glint
