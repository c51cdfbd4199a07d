// Occupancy octree (octomap) of a map for collision checking: occupied, free and unknown space.
//
// Rays from each image's camera position to its measured points make the voxels that they traverse
// free. The map's points make their voxels occupied, regardless of rays. All other space is
// unknown: behind surfaces and outside all views. Source: Hornung et al. 2013, "OctoMap"; ray
// traversal: Amanatides and Woo 1987, as in liboctomap.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kernels/cloud/depth_points.hpp"
#include "kernels/cloud/leave_out_capsules.hpp"

namespace glint {

struct OccupancySettings {
  double resolution_m = 0.02;          // side of the smallest voxel
  double stop_short_voxels = 1.5;      // ray end before its point: depth noise must not open a wall
  std::int64_t nodes_max = 1LL << 25;  // about 1 GB
};

enum class Occupied : std::uint8_t { unknown, no, yes };

struct OccupancyCounts {
  std::int64_t rays = 0;           // one per end voxel of an image
  std::int64_t out_of_range = 0;   // points outside the tree, or not finite
  std::int64_t rays_left_out = 0;  // after nodes_max was reached
  std::int64_t points_left_out = 0;
};

class Occupancy {
 public:
  // Throws InputError naming a setting that is out of range.
  explicit Occupancy(const OccupancySettings& settings);
  ~Occupancy();
  Occupancy(const Occupancy&) = delete;
  Occupancy& operator=(const Occupancy&) = delete;

  // Adds the free space of one image: pixels selected by `settings`, except points in `left_out`.
  void add_view(const DepthImageView& picture, const CameraModel& camera,
                const Pose& T_world_camera, const DepthPointSettings& settings,
                std::span<const ExclusionCapsule> left_out = {});
  // Adds the map's points; call after the views.
  void add_surface(const PointCloud& map);

  [[nodiscard]] Occupied at(const Vector3& position) const;
  [[nodiscard]] double resolution_m() const { return settings_.resolution_m; }
  [[nodiscard]] const OccupancyCounts& counts() const { return counts_; }

  // Returns a .bt file for octovis and octomap_server.
  [[nodiscard]] std::string file_bytes() const;
  // Returns the data of octomap_msgs/Octomap (binary, id "OcTree"): the file without its header.
  [[nodiscard]] std::vector<std::int8_t> message_bytes() const;

 private:
  struct Tree;
  [[nodiscard]] bool full() const;

  OccupancySettings settings_;
  std::unique_ptr<Tree> tree_;
  OccupancyCounts counts_;
};

}  // namespace glint
