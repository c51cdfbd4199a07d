#include "platform/tools/mapping/map_chain.hpp"

#include "kernels/cloud/snap_to_planes.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr int k_slice = 4096;

void check(Reason reason, const std::string& what) {
  if (reason == Reason::none) return;
  throw InputError("map: " + what + ": " + std::string(name_of(reason)) +
                   "; expected sizes and counts above 0");
}

void notice(MapCounts& counts, std::int64_t points, const std::string& what) {
  if (points > 0) counts.notices.push_back(std::to_string(points) + ' ' + what);
}

}  // namespace

struct MapChain::Kernels {
  std::vector<std::byte> memory;
  PointCloud frame, voxel_points, kept, map;
  VoxelGrid voxels;
  RadiusOutlier outliers;
  MovingLeastSquares smoothing;
  PlaneSearch planes;
  PlaneSupport support;
};

MapChain::MapChain(const MapSettings& s) : kernels_(std::make_unique<Kernels>()), settings_(s) {
  Kernels& k = *kernels_;
  const int points_max = s.voxels_max;
  if (points_max < 1 || points_max > k_cloud_points_max) check(Reason::out_of_range, "voxels_max");
  if (s.depth.stride < 1) check(Reason::out_of_range, "stride");
  if (s.smoothing.candidates_max < 1) check(Reason::out_of_range, "smoothing");
  k.memory.resize(PointCloud::bytes(k_slice) + 3 * PointCloud::bytes(points_max) +
                  VoxelGrid::bytes(points_max) + RadiusOutlier::bytes(points_max) +
                  MovingLeastSquares::bytes(s.smoothing, points_max) +
                  PlaneSearch::bytes(points_max) + PlaneSupport::bytes(points_max) +
                  Arena::k_alignment);
  Arena arena(k.memory);
  check(k.frame.prepare(k_slice, arena), "a slice of points");
  for (PointCloud* cloud : {&k.voxel_points, &k.kept, &k.map}) {
    check(cloud->prepare(points_max, arena), "voxels_max");
  }
  check(k.voxels.prepare(s.voxels, points_max, arena), "voxels");
  check(k.outliers.prepare(s.outliers, points_max, arena), "outliers");
  check(k.smoothing.prepare(s.smoothing, points_max, arena), "smoothing");
  check(k.planes.prepare(s.planes, points_max, arena), "planes");
  check(k.support.prepare(s.support, points_max, arena), "support");
}

MapChain::~MapChain() = default;

void MapChain::add_frame(const DepthImageView& picture, const CameraModel& camera,
                         const Pose& T_world_camera, std::span<const ExclusionCapsule> left_out) {
  Kernels& k = *kernels_;
  const int pixels = pixels_of(picture, settings_.depth.stride);
  for (int at = 0; at < pixels;) {
    int dropped = 0;
    k.frame.count = 0;
    at = add_depth_points(picture, camera, T_world_camera, settings_.depth, at, k_slice, k.frame,
                          dropped);
    counts_.left_out += leave_out_capsules(left_out, 0, k.frame);
    k.voxels.add(k.frame, 0, k.frame.count);
    counts_.measured += k.frame.count;
  }
}

void MapChain::finish() {
  Kernels& k = *kernels_;
  k.voxel_points.count = k.kept.count = k.map.count = 0;
  for (int at = 0; at < k.voxels.count();) at = k.voxels.write(at, k_slice, k.voxel_points);
  k.outliers.begin(k.voxel_points);
  while (!k.outliers.step(k_slice, k.kept)) {
  }
  k.smoothing.begin(k.kept);
  while (!k.smoothing.step(k_slice, k.map)) {
  }
  k.planes.begin(k.map);
  while (!k.planes.step(k_slice)) {
  }
  k.support.begin(k.map, k.planes);
  while (!k.support.step(k_slice)) {
  }
  counts_.voxels = k.voxel_points.count;
  counts_.kept = k.kept.count;
  counts_.smoothed = k.map.count;
  counts_.on_planes = -k.support.removed();
  for (int i = 0; i < k.planes.count(); ++i) counts_.on_planes += k.planes.plane(i).points;
  counts_.notices.clear();
  notice(counts_, k.voxels.dropped(), "points left out: more voxels than voxels_max");
  notice(counts_, k.voxels.out_of_range() + k.outliers.out_of_range() + k.smoothing.out_of_range(),
         "points left out: beyond the grid or not finite");
  notice(counts_, k.outliers.candidates_exceeded(), "points left out: too many neighbours");
  notice(counts_, k.smoothing.candidates_exceeded(),
         "points smoothed by a subset of their neighbours");
}

void MapChain::project_onto_planes() {
  Kernels& k = *kernels_;
  for (int at = 0; at < k.map.count;) at = snap_to_planes(k.planes, k.support, at, k_slice, k.map);
}

const PointCloud& MapChain::voxel_points() const { return kernels_->kept; }
const PointCloud& MapChain::map() const { return kernels_->map; }
int MapChain::source_of(int i) const { return kernels_->smoothing.source_of(i); }
const PlaneSearch& MapChain::planes() const { return kernels_->planes; }
const PlaneSupport& MapChain::support() const { return kernels_->support; }

}  // namespace glint
