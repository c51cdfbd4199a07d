#include "kernels/cloud/map_slices.hpp"

#include <algorithm>

#include "kernels/cloud/snap_to_planes.hpp"

namespace glint {
namespace {

// Steps per pixel (pinhole ray and voxel index included), per step in a lens table or lens
// iteration, per capsule, per voxel slot.
constexpr int k_pixel_steps = 60, k_lens_step_steps = 16, k_capsule_steps = 12, k_probe_steps = 2;
constexpr int k_call_steps = 32, k_begin_steps = 512;  // per call; per start of a stage
constexpr int k_write_steps = 12, k_snap_steps = 12;

constexpr int pixel_steps_of(RaySearch search) {
  switch (search) {
    case RaySearch::none:
      return k_pixel_steps;
    case RaySearch::newton:
      return k_pixel_steps + k_ray_steps_max * k_lens_step_steps;
    case RaySearch::table:
      return k_pixel_steps + k_lens_step_steps;
  }
  return k_pixel_steps;
}

constexpr MapSettings k_settings_max = limited_for_slices({});
constexpr int k_points_steps =
    k_call_steps + k_map_pixels_at_once * (pixel_steps_of(RaySearch::newton) +
                                           k_exclusion_capsules_max * k_capsule_steps +
                                           k_voxel_probes_max * k_probe_steps);
static_assert(k_map_item_steps_max - k_call_steps - k_begin_steps >=
              std::max({k_points_steps, RadiusOutlier::steps_max(k_settings_max.outliers),
                        MovingLeastSquares::steps_max(k_settings_max.smoothing),
                        PlaneSearch::steps_max(), PlaneSupport::steps_max(k_settings_max.support),
                        k_sort_pass_steps + k_key_steps}));

bool fits(const MapSettings& s) {
  return s.voxels_max >= 1 && s.voxels_max <= k_cloud_points_max && s.depth.stride >= 1 &&
         s.smoothing.candidates_max >= 1 &&
         s.smoothing.candidates_max <= k_map_smoothing_candidates_max &&
         s.outliers.candidates_max <= k_map_candidates_max &&
         s.support.candidates_max <= k_map_candidates_max;
}

}  // namespace

std::size_t MapSlices::bytes(const MapSettings& s) noexcept {
  if (!fits(s)) return 0;
  const int most = s.voxels_max;
  return PointCloud::bytes(k_map_pixels_at_once) + 4 * PointCloud::bytes(most) +
         VoxelGrid::bytes(most) + RadiusOutlier::bytes(most) +
         MovingLeastSquares::bytes(s.smoothing, most) + PlaneSearch::bytes(most) +
         PlaneSupport::bytes(most) + Arena::k_alignment;
}

Reason MapSlices::prepare(const MapSettings& s, int images_per_map, Arena& arena) noexcept {
  stage_ = Stage::idle;
  totals_ = {};
  images_since_ = 0;
  if (!fits(s) || images_per_map < 1) return Reason::out_of_range;
  settings_ = s;
  images_per_map_ = images_per_map;
  const int most = s.voxels_max;
  Reason reason = points_.prepare(k_map_pixels_at_once, arena);
  const auto then = [&](auto prepare) {
    if (reason == Reason::none) reason = prepare();
  };
  for (PointCloud* cloud : {&voxel_points_, &kept_, &maps_[0], &maps_[1]}) {
    then([&] { return cloud->prepare(most, arena); });
  }
  then([&] { return voxels_.prepare(s.voxels, most, arena); });
  then([&] { return outliers_.prepare(s.outliers, most, arena); });
  then([&] { return smoothing_.prepare(s.smoothing, most, arena); });
  then([&] { return planes_.prepare(s.planes, most, arena); });
  then([&] { return support_.prepare(s.support, most, arena); });
  return reason;
}

bool MapSlices::look(const MapImage& picture) noexcept {
  const DepthImageView& depth = picture.picture;
  if (!idle() || points_.capacity == 0 || depth.width < 1 || depth.height < 1 ||
      depth.depth_m.size() !=
          static_cast<std::size_t>(depth.width) * static_cast<std::size_t>(depth.height)) {
    return false;
  }
  picture_ = picture;
  picture_.left_out = picture.left_out.first(
      std::min<std::size_t>(picture.left_out.size(), k_exclusion_capsules_max));
  pixel_steps_ = pixel_steps_of(ray_search_of(picture.camera.lens)) +
                 static_cast<int>(picture_.left_out.size()) * k_capsule_steps;
  at_ = 0;
  stage_ = Stage::points;
  return true;
}

void MapSlices::start_map() noexcept {
  if (!idle() || images_since_ == 0) return;
  images_since_ = 0;
  at_ = 0;
  voxel_points_.count = kept_.count = next().count = 0;
  stage_ = Stage::voxels;
}

int MapSlices::step(int most_steps) noexcept {
  int taken = 0;
  // Terminates: every iteration takes steps.
  while (!idle() && taken < std::max(most_steps, 1)) {
    taken += step_of_stage(std::max(most_steps, 1) - taken);
  }
  return taken;
}

int MapSlices::step_of_stage(int most) noexcept {
  const SliceSize size(k_cloud_points_max, most);
  bool done = false;
  switch (stage_) {
    case Stage::idle:
      return 0;
    case Stage::points:
      return add_points();
    case Stage::voxels:
      return write_voxels(most);
    case Stage::outliers:
      done = outliers_.step(size, kept_);
      if (done) {
        smoothing_.begin(kept_);
        stage_ = Stage::smoothing;
      }
      return outliers_.steps() + k_call_steps + (done ? k_begin_steps : 0);
    case Stage::smoothing:
      done = smoothing_.step(size, next());
      if (done) {
        planes_.begin(next());
        stage_ = Stage::planes;
      }
      return smoothing_.steps() + k_call_steps + (done ? k_begin_steps : 0);
    case Stage::planes:
      done = planes_.step(size);
      if (done) {
        support_.begin(next(), planes_);
        stage_ = Stage::support;
      }
      return planes_.steps() + k_call_steps + (done ? k_begin_steps : 0);
    case Stage::support:
      done = support_.step(size);
      if (done) {
        at_ = 0;
        stage_ = Stage::snap;
      }
      return support_.steps() + k_call_steps + (done ? k_begin_steps : 0);
    case Stage::snap:
      return snap_points(most);
  }
  return 0;
}

int MapSlices::add_points() noexcept {
  const int pixels = pixels_of(picture_.picture, settings_.depth.stride), from = at_;
  const std::int64_t probes = voxels_.probes();
  points_.count = 0;
  int dropped = 0;  // stays 0: the cloud has room for all
  at_ = add_depth_points(picture_.picture, picture_.camera, picture_.T_world_camera,
                         settings_.depth, at_, k_map_pixels_at_once, points_, dropped);
  totals_.left_out += leave_out_capsules(picture_.left_out, 0, points_);
  (void)voxels_.add(points_, 0, points_.count);
  totals_.measured += points_.count;
  const int looked_at = at_ - from;
  if (at_ >= pixels) {
    ++totals_.pictures;
    totals_.voxels = voxels_.count();
    totals_.dropped = voxels_.dropped();
    ++images_since_;
    stage_ = Stage::idle;
    picture_ = {};
    if (images_since_ >= images_per_map_) start_map();
  }
  return k_call_steps + looked_at * pixel_steps_ +
         static_cast<int>(voxels_.probes() - probes) * k_probe_steps;
}

int MapSlices::write_voxels(int most) noexcept {
  const int from = at_;
  at_ = voxels_.write(at_, SliceSize(k_cloud_points_max, most).items_of(k_write_steps),
                      voxel_points_);
  if (at_ >= voxels_.count()) {
    outliers_.begin(voxel_points_);
    stage_ = Stage::outliers;
  }
  return k_call_steps + (at_ - from) * k_write_steps;
}

int MapSlices::snap_points(int most) noexcept {
  const int from = at_;
  at_ = snap_to_planes(planes_, support_, at_,
                       SliceSize(k_cloud_points_max, most).items_of(k_snap_steps), next());
  if (at_ >= next().count) publish();
  return k_call_steps + (at_ - from) * k_snap_steps;
}

void MapSlices::publish() noexcept {
  published_ = 1 - published_;
  stage_ = Stage::idle;
  ++totals_.maps;
  totals_.out_of_range = voxels_.out_of_range() + outliers_.out_of_range();
  totals_.kept = kept_.count;
  totals_.smoothed = map().count;
  totals_.planes = planes_.count();
  totals_.on_planes = -support_.removed();
  for (int i = 0; i < planes_.count(); ++i) totals_.on_planes += planes_.plane(i).points;
}

}  // namespace glint
