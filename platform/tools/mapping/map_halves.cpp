#include "platform/tools/mapping/map_halves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "kernels/angles.hpp"
#include "platform/tools/mapping/host_cloud.hpp"

namespace glint {
namespace {

constexpr int k_planes_evaluated = 3;
constexpr double k_slab_m = 0.03;  // raw points within this distance belong to a plane
constexpr double k_footprint_square_m =
    0.05;  // side of a footprint square; only squares with points count
constexpr double k_match_cosine = 0.985;  // 10 degrees
// The other half's surface near a point: a plane through at least this many points within this
// radius.
constexpr double k_around_m = 0.05;
constexpr double k_surface_points_min = 10;
constexpr double k_across_cosine = 0.93969262;  // 20 degrees

Vector3 point_of(const PointCloud& cloud, int i) {
  return {static_cast<double>(cloud.x[i]), static_cast<double>(cloud.y[i]),
          static_cast<double>(cloud.z[i])};
}

double height_over(const Plane& plane, const Vector3& point) {
  return plane.normal.dot(point) - plane.offset_m;
}

// Footprint of a map on its plane: the squares with points.
class Footprint {
 public:
  explicit Footprint(const Plane& plane) : axes_(orthonormal_basis(plane.normal)) {}
  void add(const Vector3& point) { squares_.insert(square_of(point)); }
  [[nodiscard]] bool holds(const Vector3& point) const {
    return squares_.contains(square_of(point));
  }

 private:
  [[nodiscard]] std::pair<int, int> square_of(const Vector3& point) const {
    return {static_cast<int>(std::floor(axes_.p.dot(point) / k_footprint_square_m)),
            static_cast<int>(std::floor(axes_.q.dot(point) / k_footprint_square_m))};
  }
  OrthonormalBasis axes_;
  std::set<std::pair<int, int>> squares_;
};

class Half {
 public:
  Half(const DepthSequence& sequence, const MapSettings& settings, std::size_t first)
      : chain_(settings) {
    for (std::size_t i = first; i < sequence.frames.size(); i += 2) {
      const DepthFrame& frame = sequence.frames[i];
      chain_.add_frame(frame.picture(), sequence.camera, frame.T_world_camera, frame.left_out);
    }
    chain_.finish();
  }
  [[nodiscard]] MapChain& chain() { return chain_; }

 private:
  MapChain chain_;
};

void match(const Plane& plane, const Vector3& middle, const PlaneSearch& others,
           PlaneAgreement& out) {
  for (int i = 0; i < others.count(); ++i) {
    const Plane& other = others.plane(i);
    const double cosine = std::min(std::abs(plane.normal.dot(other.normal)), 1.0);
    const double offset = std::abs(height_over(other, middle));
    if (cosine < k_match_cosine || offset > k_slab_m) continue;
    if (out.matched && offset >= out.offset_m) continue;
    out.matched = true;
    out.offset_m = offset;
    // The sine resolves small angles that the cosine does not.
    out.angle_deg =
        std::asin(std::min(plane.normal.cross(other.normal).norm(), 1.0)) * k_degrees_per_radian;
  }
}

// Evaluates the plane with raw points of images that its map does not contain.
void evaluate_by_held_out(const DepthSequence& sequence, const MapSettings& settings,
                          const Plane& plane, const Footprint& footprint, PlaneAgreement& out) {
  double sum = 0;
  for (std::size_t i = 1; i < sequence.frames.size(); i += 2) {
    const DepthFrame& frame = sequence.frames[i];
    OwnedCloud raw(frame.width * frame.height);
    int dropped = 0;
    add_depth_points(frame.picture(), sequence.camera, frame.T_world_camera, settings.depth, 0,
                     pixels_of(frame.picture(), settings.depth.stride), raw.points(), dropped);
    for (int k = 0; k < raw.points().count; ++k) {
      const Vector3 point = point_of(raw.points(), k);
      const double height = height_over(plane, point);
      if (std::abs(height) > k_slab_m || !footprint.holds(point)) continue;
      sum += height;
      ++out.held_out;
    }
  }
  out.held_out_m = out.held_out > 0 ? sum / static_cast<double>(out.held_out) : 0;
}

PlaneAgreement evaluate_plane(const DepthSequence& sequence, const MapSettings& settings,
                              const MapChain& mine, const MapChain& other, int which) {
  const Plane& plane = mine.planes().plane(which);
  const PointCloud& map = mine.map();
  PlaneAgreement out;
  Footprint footprint(plane);
  Vector3 middle = Vector3::Zero();
  double before = 0, after = 0;
  for (int i = 0; i < map.count; ++i) {
    if (mine.support().plane_of(i) != which) continue;
    const Vector3 point = point_of(map, i);
    const double smooth = height_over(plane, point);
    const double voxel = height_over(plane, point_of(mine.voxel_points(), mine.source_of(i)));
    footprint.add(point);
    middle += point;
    after += smooth * smooth;
    before += voxel * voxel;
    ++out.points;
  }
  const double n = out.points;
  out.voxel_rms_m = std::sqrt(before / n);
  out.smooth_rms_m = std::sqrt(after / n);
  match(plane, middle / n, other.planes(), out);
  evaluate_by_held_out(sequence, settings, plane, footprint, out);
  return out;
}

using Cell = std::array<int, 3>;
Cell cell_of(const Vector3& point) {
  return {static_cast<int>(std::floor(point.x() / k_around_m)),
          static_cast<int>(std::floor(point.y() / k_around_m)),
          static_cast<int>(std::floor(point.z() / k_around_m))};
}

// Plane sums of the map's points near a position, relative to it.
PlaneSums sums_around(const PointCloud& map, const std::map<Cell, std::vector<int>>& cells,
                      const Vector3& position) {
  PlaneSums sums;
  const Cell middle = cell_of(position);
  for (int step = 0; step < 27; ++step) {
    const auto found = cells.find(
        {middle[0] + step % 3 - 1, middle[1] + step / 3 % 3 - 1, middle[2] + step / 9 - 1});
    if (found == cells.end()) continue;
    for (const int i : found->second) {
      const Vector3 from_position = point_of(map, i) - position;
      if (from_position.squaredNorm() > k_around_m * k_around_m) continue;
      sums.add(from_position.x(), from_position.y(), from_position.z());
    }
  }
  return sums;
}

struct NormalCounts {
  std::int64_t evaluated = 0, across = 0;
  [[nodiscard]] double part() const {
    return evaluated > 0 ? static_cast<double>(across) / static_cast<double>(evaluated) : 0;
  }
};

// Evaluates the projection onto planes by the surface of the other half's map. The map's own
// normals selected the projected points, so they cannot show a fault.
void evaluate_projection(MapChain& mine, const MapChain& other, MapHalves& out) {
  std::map<Cell, std::vector<int>> cells;
  for (int i = 0; i < other.map().count; ++i) cells[cell_of(point_of(other.map(), i))].push_back(i);
  std::vector<Vector3> before;
  for (int i = 0; i < mine.map().count; ++i) before.push_back(point_of(mine.map(), i));
  std::array<NormalCounts, k_planes_max> normal_counts{};
  mine.project_onto_planes();
  for (int i = 0; i < mine.map().count; ++i) {
    const std::uint8_t on = mine.support().plane_of(i);
    if (on == PlaneSearch::k_no_plane) continue;
    ++out.projected;
    const Vector3& from = before[static_cast<std::size_t>(i)];
    out.displacement_max_m =
        std::max(out.displacement_max_m, (point_of(mine.map(), i) - from).norm());
    const PlaneSums around = sums_around(other.map(), cells, from);
    if (around.n < k_surface_points_min) continue;
    NormalCounts& on_plane = normal_counts[on];
    ++on_plane.evaluated;
    const Vector3 normal = fit_plane(around).normal;
    on_plane.across +=
        std::abs(normal.dot(mine.planes().plane(on).normal)) < k_across_cosine ? 1 : 0;
  }
  NormalCounts all;
  for (std::size_t i = 0; i < normal_counts.size(); ++i) {
    all.evaluated += normal_counts[i].evaluated;
    all.across += normal_counts[i].across;
    if (i < out.planes.size()) out.planes[i].wrong_normal_share = normal_counts[i].part();
  }
  out.evaluated = all.evaluated;
  out.wrong_normal_share = all.part();
}

}  // namespace

MapHalves compare_halves(const DepthSequence& sequence, const MapSettings& settings) {
  Half even(sequence, settings, 0), odd(sequence, settings, 1);
  MapHalves out;
  const int planes = std::min(even.chain().planes().count(), k_planes_evaluated);
  for (int i = 0; i < planes; ++i) {
    out.planes.push_back(evaluate_plane(sequence, settings, even.chain(), odd.chain(), i));
  }
  evaluate_projection(even.chain(), odd.chain(), out);
  return out;
}

}  // namespace glint
