#include "platform/tools/mapping/occupancy.hpp"

#include <octomap/octomap.h>

#include <cmath>
#include <sstream>

#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr int k_points_at_once = 4096;
constexpr double k_half_voxels = 32768;  // half the tree's size along an axis, voxels
constexpr double k_resolution_min_m = 0.002, k_resolution_max_m = 1.0;

octomap::point3d point_of(const Vector3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace

struct Occupancy::Tree {
  explicit Tree(double resolution) : octree(resolution) {
    slice_memory.resize(PointCloud::bytes(k_points_at_once) + Arena::k_alignment);
    Arena arena(slice_memory);
    (void)slice.prepare(k_points_at_once, arena);
  }
  // compact() updates the inner nodes: once per image, not per voxel.
  void set(const octomap::OcTreeKey& key, bool occupied) {
    octree.setNodeValue(key, occupied ? octree.getProbHitLog() : octree.getProbMissLog(), true);
  }
  // Returns whether the tree has a voxel there. The library converts coordinates to integers
  // without a range check.
  [[nodiscard]] bool reaches(const Vector3& position) const {
    const double half_m = k_half_voxels * octree.getResolution();
    return position.allFinite() && position.cwiseAbs().maxCoeff() < half_m;
  }
  void compact() {
    octree.updateInnerOccupancy();
    octree.prune();
  }

  octomap::OcTree octree;
  std::vector<std::byte> slice_memory;
  PointCloud slice;
  octomap::KeySet seen, free;  // of one image
  octomap::KeyRay ray;
};

Occupancy::Occupancy(const OccupancySettings& settings) : settings_(settings) {
  if (!(settings.resolution_m >= k_resolution_min_m &&
        settings.resolution_m <= k_resolution_max_m)) {
    throw InputError("octomap: resolution " + std::to_string(settings.resolution_m) +
                     " m; expected 0.002 to 1");
  }
  if (!(settings.stop_short_voxels >= 0 && settings.stop_short_voxels <= 100) ||
      settings.nodes_max < 1) {
    throw InputError("octomap: stop_short_voxels or nodes_max; expected 0 to 100, and 1 or more");
  }
  tree_ = std::make_unique<Tree>(settings.resolution_m);
}

Occupancy::~Occupancy() = default;

bool Occupancy::full() const {
  return static_cast<std::int64_t>(tree_->octree.size()) >= settings_.nodes_max;
}

void Occupancy::add_view(const DepthImageView& picture, const CameraModel& camera,
                         const Pose& T_world_camera, const DepthPointSettings& settings,
                         std::span<const ExclusionCapsule> left_out) {
  Tree& t = *tree_;
  t.seen.clear();
  t.free.clear();
  const Vector3 eye = T_world_camera.translation;
  const double short_m = settings_.stop_short_voxels * settings_.resolution_m;
  const int pixels = pixels_of(picture, settings.stride);
  for (int at = 0; at < pixels;) {
    int dropped = 0;
    t.slice.count = 0;
    at = add_depth_points(picture, camera, T_world_camera, settings, at, k_points_at_once, t.slice,
                          dropped);
    (void)leave_out_capsules(left_out, 0, t.slice);
    for (int i = 0; i < t.slice.count; ++i) {
      const Vector3 point(t.slice.x[i], t.slice.y[i], t.slice.z[i]);
      octomap::OcTreeKey key;
      if (!t.reaches(eye) || !t.reaches(point) ||
          !t.octree.coordToKeyChecked(point_of(point), key)) {
        ++counts_.out_of_range;
        continue;
      }
      if (!t.seen.insert(key).second) continue;  // an earlier ray of this image ended there
      const double range = (point - eye).norm();
      if (range <= short_m) continue;
      if (full()) {
        ++counts_.rays_left_out;
        continue;
      }
      ++counts_.rays;
      const Vector3 end = eye + (point - eye) * ((range - short_m) / range);
      if (!t.octree.computeRayKeys(point_of(eye), point_of(end), t.ray)) continue;
      for (const octomap::OcTreeKey& passed : t.ray) {
        if (t.free.insert(passed).second) t.set(passed, false);
      }
    }
  }
  t.compact();
}

void Occupancy::add_surface(const PointCloud& map) {
  Tree& t = *tree_;
  for (int i = 0; i < map.count; ++i) {
    const Vector3 point(map.x[i], map.y[i], map.z[i]);
    octomap::OcTreeKey key;
    if (!t.reaches(point) || !t.octree.coordToKeyChecked(point_of(point), key)) {
      ++counts_.out_of_range;
    } else if (full() && t.octree.search(key) == nullptr) {
      ++counts_.points_left_out;
    } else {
      t.set(key, true);
    }
  }
  t.compact();
}

Occupied Occupancy::at(const Vector3& position) const {
  if (!tree_->reaches(position)) return Occupied::unknown;
  const octomap::OcTreeNode* node = tree_->octree.search(point_of(position));
  if (node == nullptr) return Occupied::unknown;
  return tree_->octree.isNodeOccupied(node) ? Occupied::yes : Occupied::no;
}

// The library's own writer prints a message to stderr.
std::string Occupancy::file_bytes() const {
  std::ostringstream out(std::ios::binary);
  out << "# Octomap OcTree binary file\nid OcTree\nsize " << tree_->octree.size() << "\nres "
      << settings_.resolution_m << "\ndata\n";
  tree_->octree.writeBinaryData(out);
  return std::move(out).str();
}

std::vector<std::int8_t> Occupancy::message_bytes() const {
  std::ostringstream out(std::ios::binary);
  tree_->octree.writeBinaryData(out);
  const std::string bytes = std::move(out).str();
  return {bytes.begin(), bytes.end()};
}

}  // namespace glint
