// Point cloud of any size outside the kernels, as in files.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "kernels/cloud/point_cloud.hpp"

namespace glint {

struct HostCloud {
  std::vector<std::array<float, 3>> points;   // metres
  std::vector<std::array<float, 3>> normals;  // as many as points, or none
};

// A kernel's point cloud that owns its memory.
class OwnedCloud {
 public:
  explicit OwnedCloud(int capacity);
  [[nodiscard]] PointCloud& points() { return points_; }
  [[nodiscard]] const PointCloud& points() const { return points_; }

 private:
  std::vector<std::byte> memory_;
  PointCloud points_;
};

[[nodiscard]] HostCloud host_cloud_of(const PointCloud& cloud);
// Capacity: the size of the cloud, at least 1.
[[nodiscard]] OwnedCloud owned_cloud_of(const HostCloud& cloud);

}  // namespace glint
