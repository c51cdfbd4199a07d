// Depth image of a wall in two parts, its sliced map, and the output of the kernels run separately.
#pragma once

#include <map>
#include <vector>

#include "clouds.hpp"
#include "kernels/cloud/map_slices.hpp"

namespace glint::mapped_wall {

inline constexpr int k_no_map = 1'000'000;  // images a map: makes no map

inline MapSettings small_settings() {
  MapSettings settings;
  settings.voxels_max = 2'000;
  settings.planes.points_min = 100;
  settings.support.support_share_min = 1;
  return limited_for_slices(settings);
}

struct TestMap {
  explicit TestMap(const MapSettings& settings = small_settings(), int images_per_map = k_no_map) {
    prepare(settings, images_per_map);
  }
  void prepare(const MapSettings& settings, int images_per_map) {
    memory.assign(MapSlices::bytes(settings), std::byte{0});
    Arena arena(memory);
    EXPECT_EQ(map.prepare(settings, images_per_map, arena), Reason::none);
  }
  void run(int steps = 50'000) {
    while (!map.idle()) (void)map.step(steps);
  }
  std::vector<std::byte> memory;
  MapSlices map;
};

struct Picture {
  int width, height;
  std::vector<float> depth_m;
  CameraModel camera;
  Pose T_world_camera;
  std::vector<ExclusionCapsule> left_out;

  Picture(int of_width, int of_height, float depth) : width(of_width), height(of_height) {
    depth_m.assign(static_cast<std::size_t>(width * height), depth);
    camera.width = width, camera.height = height;
    camera.fx = camera.fy = 100, camera.cx = 20, camera.cy = 15;
  }
  [[nodiscard]] MapImage view() const {
    return {{width, height, depth_m}, camera, T_world_camera, left_out};
  }
};

// A wall whose right part is 4 cm farther away, with isolated points in front of it.
inline Picture wall() {
  Picture picture(40, 30, 1.005f);
  for (int i = 0; i < 40 * 30; ++i) {
    float& depth = picture.depth_m[static_cast<std::size_t>(i)];
    if (i % 40 > 25) depth = 1.045f;
    if (i % 40 % 11 == 3 && i / 40 % 9 == 4) depth = 0.5f;
  }
  return picture;
}

// Outputs and step counts of the kernels run separately, each call with a limit of one step.
struct SeparateKernels {
  struct StageCost {
    int calls = 0, steps = 0;
  };
  MapSettings settings = small_settings();
  TestMemory memory;
  TestCloud points, voxel_points, kept, smoothed;
  VoxelGrid voxels;
  RadiusOutlier outliers;
  MovingLeastSquares smoothing;
  PlaneSearch planes;
  PlaneSupport support;
  std::map<MapSlices::Stage, StageCost> cost_of_stage;

  explicit SeparateKernels(const Picture& picture)
      : memory(MapSlices::bytes(settings)),
        points(2'000),
        voxel_points(2'000),
        kept(2'000),
        smoothed(2'000) {
    const int most = settings.voxels_max;
    EXPECT_EQ(voxels.prepare(settings.voxels, most, memory.arena()), Reason::none);
    EXPECT_EQ(outliers.prepare(settings.outliers, most, memory.arena()), Reason::none);
    EXPECT_EQ(smoothing.prepare(settings.smoothing, most, memory.arena()), Reason::none);
    EXPECT_EQ(planes.prepare(settings.planes, most, memory.arena()), Reason::none);
    EXPECT_EQ(support.prepare(settings.support, most, memory.arena()), Reason::none);
    int dropped = 0;
    (void)add_depth_points(picture.view().picture, picture.camera, picture.T_world_camera, {}, 0,
                           2'000, points.points, dropped);
    for (int at = 0; at < points.points.count;) {
      at = voxels.add(points.points, at, k_map_pixels_at_once);
    }
    voxels.write(0, most, voxel_points.points);
    const SliceSize one(k_cloud_points_max, 1);
    outliers.begin(voxel_points.points);
    run(
        MapSlices::Stage::outliers, [&] { return outliers.step(one, kept.points); }, outliers);
    smoothing.begin(kept.points);
    run(
        MapSlices::Stage::smoothing, [&] { return smoothing.step(one, smoothed.points); },
        smoothing);
    planes.begin(smoothed.points);
    run(
        MapSlices::Stage::planes, [&] { return planes.step(one); }, planes);
    support.begin(smoothed.points, planes);
    run(
        MapSlices::Stage::support, [&] { return support.step(one); }, support);
  }
  template <class Step, class Kernel>
  void run(MapSlices::Stage stage, Step step, const Kernel& kernel) {
    StageCost& of_stage = cost_of_stage[stage];
    for (bool done = false; !done; ++of_stage.calls) {
      done = step();
      of_stage.steps += kernel.steps();
    }
  }
};

}  // namespace glint::mapped_wall
