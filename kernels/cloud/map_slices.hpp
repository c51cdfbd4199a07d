// Incremental point-cloud map from depth images, in slices of bounded work.
//
// What:     adds the points of an image to the voxels, without those inside the tracked pen and
//           hands. After every images_per_map images it builds a new map: voxels, outlier removal,
//           smoothing, planes, projection onto planes. The new map then replaces the published one.
// Cost:     a slice ends once its steps (slice_size.hpp) are used up; a map of v voxels takes about
//           300 v steps, an image 60 or more a pixel.
// Worst:    the last item of a slice exceeds its steps by at most k_map_item_steps_max. No image is
//           accepted while a map is built: the caller drops images. Voxels beyond voxels_max are
//           counted and discarded.
// Accuracy: that of the chain: slices of any size give the same bits.
// Source:   Puljiz et al., Inside-out Infrared Marker Tracking via Head Mounted Displays for Smart
//           Robot Programming (the chain).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "kernels/cloud/leave_out_capsules.hpp"
#include "kernels/cloud/map_settings.hpp"

namespace glint {

// Largest settings of a map in slices, so that the work for one point is bounded.
inline constexpr int k_map_candidates_max = 1024, k_map_smoothing_candidates_max = 512;
inline constexpr int k_map_item_steps_max = 13'000;
inline constexpr int k_map_pixels_at_once = 8;

// Reduces the numbers of candidates to these limits.
[[nodiscard]] constexpr MapSettings limited_for_slices(MapSettings settings) noexcept {
  const auto at_most = [](int& value, int most) { value = value < most ? value : most; };
  at_most(settings.outliers.candidates_max, k_map_candidates_max);
  at_most(settings.smoothing.candidates_max, k_map_smoothing_candidates_max);
  at_most(settings.support.candidates_max, k_map_candidates_max);
  return settings;
}

// A depth image and the pose of its camera. All borrowed.
struct MapImage {
  DepthImageView picture;
  CameraModel camera;
  Pose T_world_camera;
  std::span<const ExclusionCapsule> left_out;  // in the world frame
};

// Counts since prepare().
struct MapTotals {
  std::int64_t pictures = 0, measured = 0, left_out = 0, maps = 0;
  std::int64_t dropped = 0, out_of_range = 0;  // points: beyond voxels_max, beyond the grid
  int voxels = 0;
  int kept = 0, smoothed = 0, planes = 0, on_planes = 0;  // of the published map
};

class MapSlices {
 public:
  // Bytes that prepare() takes from an arena; 0 if prepare() would reject the settings.
  [[nodiscard]] static std::size_t bytes(const MapSettings& settings) noexcept;
  // Reason: none; out_of_range (a setting, also one that would exceed k_map_item_steps_max);
  // not_prepared (too little left in the arena).
  [[nodiscard]] Reason prepare(const MapSettings& settings, int images_per_map,
                               Arena& arena) noexcept;

  // Returns true if no work is pending: the next image is accepted and borrowed data may be
  // released.
  [[nodiscard]] bool idle() const noexcept { return stage_ == Stage::idle; }
  // Starts an image. Returns false if work is pending or the image's size differs from its data.
  [[nodiscard]] bool look(const MapImage& picture) noexcept GLINT_NONBLOCKING;
  // Starts a map of the present voxels. Does nothing if no image was added since the last map or
  // work is pending.
  void start_map() noexcept GLINT_NONBLOCKING;
  // Runs one slice. Returns the steps taken: 0 if no work is pending, else at most most_steps +
  // k_map_item_steps_max.
  int step(int most_steps) noexcept GLINT_NONBLOCKING;

  // The published map; empty before the first one is complete.
  [[nodiscard]] const PointCloud& map() const noexcept { return maps_[published_]; }
  [[nodiscard]] const MapTotals& totals() const noexcept { return totals_; }

  // Pending work: points of an image, or the stages of a new map.
  enum class Stage : std::uint8_t {
    idle,
    points,
    voxels,
    outliers,
    smoothing,
    planes,
    support,
    snap
  };
  [[nodiscard]] Stage stage() const noexcept { return stage_; }

 private:
  [[nodiscard]] PointCloud& next() noexcept { return maps_[1 - published_]; }
  [[nodiscard]] int step_of_stage(int most_steps) noexcept;
  [[nodiscard]] int add_points() noexcept;
  [[nodiscard]] int write_voxels(int most_steps) noexcept;
  [[nodiscard]] int snap_points(int most_steps) noexcept;
  void publish() noexcept;

  MapSettings settings_;
  int images_per_map_ = 1, images_since_ = 0;
  Stage stage_ = Stage::idle;
  MapImage picture_;
  int at_ = 0, pixel_steps_ = 0;
  PointCloud points_, voxel_points_, kept_;
  std::array<PointCloud, 2> maps_;
  std::size_t published_ = 0;
  VoxelGrid voxels_;
  RadiusOutlier outliers_;
  MovingLeastSquares smoothing_;
  PlaneSearch planes_;
  PlaneSupport support_;
  MapTotals totals_;
};

}  // namespace glint
