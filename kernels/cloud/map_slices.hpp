// A map that grows picture by picture, in slices of bounded work.
//
// What:     a picture's points, without those within the tracked pen and hands, go into the voxels;
//           after every pictures_a_map pictures voxels, outliers, smoothing, planes and the move
//           onto them make a new map beside the one that is out, which it then replaces whole.
// Cost:     a slice ends once its steps (slice_size.hpp) are used up; a map of v voxels takes some
//           300 v steps, a picture 30 a pixel.
// Worst:    the last point of a slice goes k_map_item_steps_max beyond its steps. While a map is
//           made pictures wait for it: their owner leaves some out. Voxels beyond voxels_max are
//           counted and left out.
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

// What a map in slices may be asked for: so that no one of its points is a slice of its own.
inline constexpr int k_map_candidates_max = 1024, k_map_smoothed_over_max = 512;
inline constexpr int k_map_item_steps_max = 13'000;
inline constexpr int k_map_pixels_at_once = 8;

// The same with no more candidates than that.
[[nodiscard]] constexpr MapSettings in_slices(MapSettings settings) noexcept {
  const auto at_most = [](int& value, int most) { value = value < most ? value : most; };
  at_most(settings.outliers.candidates_max, k_map_candidates_max);
  at_most(settings.smoothing.candidates_max, k_map_smoothed_over_max);
  at_most(settings.support.candidates_max, k_map_candidates_max);
  return settings;
}

// A depth picture, and how the camera that took it stood. All borrowed.
struct MapPicture {
  DepthPicture picture;
  CameraModel camera;
  Pose T_world_camera;
  std::span<const LeftOut> left_out;  // in the world
};

// Since prepare().
struct MapTotals {
  std::int64_t pictures = 0, measured = 0, left_out = 0, maps = 0;
  std::int64_t dropped = 0, out_of_range = 0;  // points: beyond voxels_max, beyond the grid
  int voxels = 0;
  int kept = 0, smoothed = 0, planes = 0, on_planes = 0;  // of the map that is out
};

class MapSlices {
 public:
  // What prepare() takes of an arena; 0 where it would refuse the settings.
  [[nodiscard]] static std::size_t bytes(const MapSettings& settings) noexcept;
  // Reason: none; out_of_range (a setting; one that would make a slice longer than said above);
  // not_prepared (the arena has not enough left).
  [[nodiscard]] Reason prepare(const MapSettings& settings, int pictures_a_map,
                               Arena& arena) noexcept;

  // Whether nothing is under way: pictures may be shown, what they borrow may go.
  [[nodiscard]] bool idle() const noexcept { return stage_ == Stage::idle; }
  // Begins with a picture. False: something is under way, or the picture's size is not its own.
  [[nodiscard]] bool look(const MapPicture& picture) noexcept GLINT_NONBLOCKING;
  // Begins a map of what there is by now, if there is more than in the one that is out and nothing
  // is under way.
  void make_map() noexcept GLINT_NONBLOCKING;
  // One slice. Gives the steps that it took: 0 if nothing is under way, else at most
  // most_steps + k_map_item_steps_max.
  int step(int most_steps) noexcept GLINT_NONBLOCKING;

  // The map that is out, whole; nothing in it before the first one is made.
  [[nodiscard]] const PointCloud& map() const noexcept { return maps_[out_]; }
  [[nodiscard]] const MapTotals& totals() const noexcept { return totals_; }

  // What is under way: points of a picture, then those of a new map.
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
  [[nodiscard]] PointCloud& next() noexcept { return maps_[1 - out_]; }
  [[nodiscard]] int step_of_stage(int most_steps) noexcept;
  [[nodiscard]] int add_points() noexcept;
  [[nodiscard]] int write_voxels(int most_steps) noexcept;
  [[nodiscard]] int snap_points(int most_steps) noexcept;
  void publish() noexcept;

  MapSettings settings_;
  int pictures_a_map_ = 1, pictures_since_ = 0;
  Stage stage_ = Stage::idle;
  MapPicture picture_;
  int at_ = 0, pixel_steps_ = 0;
  PointCloud points_, voxel_points_, kept_;
  std::array<PointCloud, 2> maps_;
  std::size_t out_ = 0;
  VoxelGrid voxels_;
  RadiusOutlier outliers_;
  MovingLeastSquares smoothing_;
  PlaneSearch planes_;
  PlaneSupport support_;
  MapTotals totals_;
};

}  // namespace glint
