// Clusters of recurring points in the tool frame: separates markers from stray points.
#pragma once

#include <vector>

#include "kernels/geometry.hpp"

namespace glint {

class MarkerClusters {
 public:
  explicit MarkerClusters(double radius_m) : radius_m_(radius_m) {}

  // Adds the point to the first cluster within the radius, or starts a new cluster.
  void add(const Vector3& point_m) {
    for (Place& place : places_) {
      if ((place.mean_m - point_m).norm() > radius_m_) continue;
      ++place.count;
      place.mean_m += (point_m - place.mean_m) / place.count;
      return;
    }
    if (places_.size() < k_places_max) places_.push_back({point_m, 1});
  }

  [[nodiscard]] std::vector<Vector3> seen_at_least(double count) const {
    std::vector<Vector3> found;
    for (const Place& place : places_)
      if (place.count >= count) found.push_back(place.mean_m);
    return found;
  }
  [[nodiscard]] double radius_m() const { return radius_m_; }

 private:
  static constexpr std::size_t k_places_max = 10'000;  // each stray may start one
  struct Place {
    Vector3 mean_m;
    int count = 0;
  };
  double radius_m_;
  std::vector<Place> places_;
};

}  // namespace glint
