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
    for (Cluster& cluster : clusters_) {
      if ((cluster.mean_m - point_m).norm() > radius_m_) continue;
      ++cluster.count;
      cluster.mean_m += (point_m - cluster.mean_m) / cluster.count;
      return;
    }
    if (clusters_.size() < k_clusters_max) clusters_.push_back({point_m, 1});
  }

  [[nodiscard]] std::vector<Vector3> centres_with_count_min(double count) const {
    std::vector<Vector3> found;
    for (const Cluster& cluster : clusters_)
      if (cluster.count >= count) found.push_back(cluster.mean_m);
    return found;
  }
  [[nodiscard]] double radius_m() const { return radius_m_; }

 private:
  static constexpr std::size_t k_clusters_max = 10'000;  // each stray may start one
  struct Cluster {
    Vector3 mean_m;
    int count = 0;
  };
  double radius_m_;
  std::vector<Cluster> clusters_;
};

}  // namespace glint
