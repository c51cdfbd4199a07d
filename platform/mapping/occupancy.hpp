// What is occupied, free and unknown around a map's surfaces, for collision checking: an octomap.
//
// Rays from each picture's place to what it measured make what they pass through free; the map's
// points make their voxels occupied, whatever rays grazed them. All else is unknown: what lies
// behind a surface, and whatever nobody looked at. Source: Hornung et al. 2013, "OctoMap"; rays
// after Amanatides and Woo 1987, as liboctomap has them.
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
  double resolution_m = 0.02;      // side of the smallest voxel
  double stop_short_voxels = 1.5;  // a ray ends this far before its point: noise is no way through
  std::int64_t nodes_max = 1LL << 25;  // about 1 GB
};

enum class Occupied : std::uint8_t { unknown, no, yes };

struct OccupancyCounts {
  std::int64_t rays = 0;           // of different voxels
  std::int64_t out_of_range = 0;   // points beyond the tree, or not finite
  std::int64_t rays_left_out = 0;  // once nodes_max were reached
  std::int64_t points_left_out = 0;
};

class Occupancy {
 public:
  // Throws InputError naming a setting that is out of range.
  explicit Occupancy(const OccupancySettings& settings);
  ~Occupancy();
  Occupancy(const Occupancy&) = delete;
  Occupancy& operator=(const Occupancy&) = delete;

  // What one picture saw through; the pixels that `settings` takes, but for points in `left_out`.
  void add_view(const DepthPicture& picture, const CameraModel& camera, const Pose& T_world_camera,
                const DepthPointSettings& settings, std::span<const LeftOut> left_out = {});
  // The map's points, after the views.
  void add_surface(const PointCloud& map);

  [[nodiscard]] Occupied at(const Vector3& place) const;
  [[nodiscard]] double resolution_m() const { return settings_.resolution_m; }
  [[nodiscard]] const OccupancyCounts& counts() const { return counts_; }

  // A .bt file, as octovis and octomap_server read it.
  [[nodiscard]] std::string file_bytes() const;
  // The data of octomap_msgs/Octomap (binary, id "OcTree"): the same without the file's header.
  [[nodiscard]] std::vector<std::int8_t> message_bytes() const;

 private:
  struct Tree;
  [[nodiscard]] bool full() const;

  OccupancySettings settings_;
  std::unique_ptr<Tree> tree_;
  OccupancyCounts counts_;
};

}  // namespace glint
