// Places of a tool where points recur: what is a marker and not a stray.
#pragma once

#include <vector>

#include "kernels/geometry.hpp"

namespace glint {

class MarkerClusters {
 public:
  explicit MarkerClusters(double radius_m) : radius_m_(radius_m) {}

  // Joins the first place within the radius, or founds one.
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
  static constexpr std::size_t k_places_max = 10'000;  // strays found a place each
  struct Place {
    Vector3 mean_m;
    int count = 0;
  };
  double radius_m_;
  std::vector<Place> places_;
};

}  // namespace glint
