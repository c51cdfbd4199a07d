// Map from depth images: the kernels voxel grid, outlier removal, smoothing and planes in sequence.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kernels/cloud/leave_out_capsules.hpp"
#include "kernels/cloud/map_settings.hpp"

namespace glint {

struct MapCounts {
  std::int64_t measured = 0;  // points of all images
  std::int64_t left_out = 0;  // points inside pen and hands; not in `measured`
  int voxels = 0, kept = 0, smoothed = 0, on_planes = 0;
  std::vector<std::string> notices;  // overflows and dropped points
};

class MapChain {
 public:
  // Throws InputError naming a setting that is out of range.
  explicit MapChain(const MapSettings& settings);
  ~MapChain();
  MapChain(const MapChain&) = delete;
  MapChain& operator=(const MapChain&) = delete;

  void add_frame(const DepthImageView& picture, const CameraModel& camera,
                 const Pose& T_world_camera, std::span<const ExclusionCapsule> left_out = {});
  // Runs voxels to planes for all frames so far; does not project points onto the planes yet.
  void finish();
  // Projects the map's points onto their planes.
  void project_onto_planes();

  [[nodiscard]] const PointCloud& voxel_points() const;  // after outlier removal
  [[nodiscard]] const PointCloud& map() const;
  // Index in voxel_points() of the map's i-th point.
  [[nodiscard]] int source_of(int i) const;
  [[nodiscard]] const PlaneSearch& planes() const;
  // Plane of each map point.
  [[nodiscard]] const PlaneSupport& support() const;
  [[nodiscard]] const MapCounts& counts() const { return counts_; }

 private:
  struct Kernels;
  std::unique_ptr<Kernels> kernels_;
  MapSettings settings_;
  MapCounts counts_;
};

}  // namespace glint
