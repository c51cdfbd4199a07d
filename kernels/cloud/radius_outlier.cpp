#include "kernels/cloud/radius_outlier.hpp"

#include <cmath>

namespace glint {

Reason RadiusOutlier::prepare(const RadiusOutlierSettings& settings, int points,
                              Arena& arena) noexcept {
  prepared_ = false;
  if (!(settings.radius_m > 0 && std::isfinite(1 / settings.radius_m)) ||
      settings.neighbours_min < 0 || settings.candidates_max < 1) {
    return Reason::out_of_range;
  }
  settings_ = settings;
  const Reason reason = grid_.prepare(points, arena);
  prepared_ = reason == Reason::none;
  return reason;
}

void RadiusOutlier::begin(const PointCloud& points) noexcept {
  if (!prepared_) return;
  cloud_ = &points;
  grid_.begin(points, settings_.radius_m);
  walk_.begin();
  dropped_ = candidates_exceeded_ = 0;
}

// Returns true if enough other points are near. `near` counts the point itself too.
bool RadiusOutlier::has_neighbours(int point) noexcept {
  const float* const xs = grid_.x();
  const float* const ys = grid_.y();
  const float* const zs = grid_.z();
  const FourFloats x = broadcast_four(xs[point]), y = broadcast_four(ys[point]),
                   z = broadcast_four(zs[point]);
  const FourFloats limit = broadcast_four(settings_.radius_m * settings_.radius_m);
  int left = settings_.candidates_max, near = 0;
  compared_ = 0;
  for (const NeighbourSweep::Row& row : walk_.rows()) {
    for (int i = row.begin; i < row.end; i += 4) {
      if (left <= 0) {
        ++candidates_exceeded_;
        compared_ = settings_.candidates_max;
        return false;
      }
      const FourFloats dx = load_four(xs + i) - x, dy = load_four(ys + i) - y,
                       dz = load_four(zs + i) - z;
      const FourMasks within = (dx * dx + dy * dy) + dz * dz <= limit;
      near += count_of(within & first_lanes(std::min(row.end - i, left)));
      left -= 4;
      compared_ = settings_.candidates_max - left;
      if (near > settings_.neighbours_min) return true;
    }
  }
  return false;
}

bool RadiusOutlier::step(SliceSize most, PointCloud& kept) noexcept {
  if (!prepared_) return true;
  return walk_.step(
      grid_, most, [] { return 0; },
      [&](int point) {
        if (has_neighbours(point)) {
          const float weight = cloud_->weight[grid_.index_in_cloud(point)];
          if (!kept.add(grid_.x()[point], grid_.y()[point], grid_.z()[point], weight)) ++dropped_;
        }
        return k_outlier_steps + k_candidate_steps * compared_;
      });
}

Reason RadiusOutlier::reason() const noexcept {
  if (!prepared_) return Reason::not_prepared;
  if (dropped() > 0) return Reason::cloud_full;
  return candidates_exceeded_ > 0 ? Reason::search_full : Reason::none;
}

}  // namespace glint
