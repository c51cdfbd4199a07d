// From depth pictures to a map: voxels, outliers, smoothing, planes; the kernels in their order.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kernels/cloud/leave_out_capsules.hpp"
#include "kernels/cloud/map_settings.hpp"

namespace glint {

struct MapCounts {
  std::int64_t measured = 0;  // points of all pictures
  std::int64_t left_out = 0;  // not among these: within the pen and the hands
  int voxels = 0, kept = 0, smoothed = 0, on_planes = 0;
  std::vector<std::string> notices;  // what was full or left out
};

class MapChain {
 public:
  // Throws InputError naming a setting that is out of range.
  explicit MapChain(const MapSettings& settings);
  ~MapChain();
  MapChain(const MapChain&) = delete;
  MapChain& operator=(const MapChain&) = delete;

  void add_frame(const DepthPicture& picture, const CameraModel& camera, const Pose& T_world_camera,
                 std::span<const LeftOut> left_out = {});
  // Voxels to planes of all frames so far; nothing is moved onto the planes yet.
  void finish();
  // Moves the map's points onto their planes.
  void snap();

  [[nodiscard]] const PointCloud& voxel_points() const;  // those that outliers were dropped from
  [[nodiscard]] const PointCloud& map() const;
  // Which of voxel_points() became the map's i-th point.
  [[nodiscard]] int source_of(int i) const;
  [[nodiscard]] const PlaneSearch& planes() const;
  // The plane that each of the map's points is on.
  [[nodiscard]] const PlaneSupport& support() const;
  [[nodiscard]] const MapCounts& counts() const { return counts_; }

 private:
  struct Kernels;
  std::unique_ptr<Kernels> kernels_;
  MapSettings settings_;
  MapCounts counts_;
};

}  // namespace glint
