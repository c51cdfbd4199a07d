#include "platform/tools/mapping/host_cloud.hpp"

#include <stdexcept>

namespace glint {

OwnedCloud::OwnedCloud(int capacity) : memory_(PointCloud::bytes(capacity) + Arena::k_alignment) {
  Arena arena(memory_);
  if (points_.prepare(capacity, arena) != Reason::none) {
    throw std::length_error("a cloud of " + std::to_string(capacity) + " points; expected 1 to " +
                            std::to_string(k_cloud_points_max));
  }
}

HostCloud host_cloud_of(const PointCloud& cloud) {
  HostCloud out;
  for (int i = 0; i < cloud.count; ++i) {
    out.points.push_back({cloud.x[i], cloud.y[i], cloud.z[i]});
    out.normals.push_back({cloud.normal_x[i], cloud.normal_y[i], cloud.normal_z[i]});
  }
  return out;
}

OwnedCloud owned_cloud_of(const HostCloud& cloud) {
  OwnedCloud out(std::max(1, static_cast<int>(cloud.points.size())));
  PointCloud& to = out.points();
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const auto& p = cloud.points[i];
    (void)to.add(p[0], p[1], p[2]);
    if (cloud.normals.size() != cloud.points.size()) continue;
    const auto at = static_cast<int>(i);
    to.normal_x[at] = cloud.normals[i][0];
    to.normal_y[at] = cloud.normals[i][1];
    to.normal_z[at] = cloud.normals[i][2];
  }
  return out;
}

}  // namespace glint
