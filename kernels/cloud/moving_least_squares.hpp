// Moving-least-squares smoothing of a point cloud, with normals.
//
// What:     applies local_surface.hpp to every point of a cloud, over all points within radius_m of
//           it. The output is sorted by the cells of a grid.
// Cost:     sorting (neighbour_grid.hpp); for each point at most candidates_max distances, and
//           local_surface for its neighbours: about 80 and 30 at voxels of a third of the radius.
// Worst:    more than candidates_max points in the nine rows of cells around a point: the point's
//           own row counts first, then the others in their order, and cut() counts the point.
//           Discards a point with fewer than k_plane_neighbours_min neighbours, itself included.
// Accuracy: order 2 leaves the bias of a curved surface below 0.6 mm at a radius of curvature of 50
//           mm (moving_least_squares_accuracy_test.cpp).
// Source:   Alexa et al. 2003, IEEE Transactions on Visualization and Computer Graphics 9(1).
#pragma once

#include "kernels/cloud/local_surface.hpp"
#include "kernels/cloud/neighbour_grid.hpp"
#include "kernels/cloud/neighbour_walk.hpp"

namespace glint {

// Steps: per candidate of a cell; per point, plus per candidate and per neighbour of a point.
inline constexpr int k_gather_steps = 4, k_surface_steps = 600, k_near_steps = 5,
                     k_neighbour_steps = 12;

// Weight of a neighbour: 1, or the number of measurements that it is the mean of. Where many
// measurements form a voxel's point, points in the middle of the noise have far more of them than
// points at its edge; equal weights then bend the surface.
enum class NeighbourWeights : std::uint8_t { equal, by_measurements };

struct MovingLeastSquaresSettings {
  float radius_m = 0.03f;
  int candidates_max = 4096;
  NeighbourWeights weights = NeighbourWeights::by_measurements;
};

class MovingLeastSquares {
 public:
  // Bytes that prepare() takes from an arena.
  [[nodiscard]] static constexpr std::size_t bytes(const MovingLeastSquaresSettings& settings,
                                                   int points) noexcept {
    return NeighbourGrid::bytes(points) + Column<std::int32_t>::bytes(points) +
           8 * Column<float>::bytes(settings.candidates_max + k_four_padding);
  }
  // Reason: none; out_of_range (a setting, points); not_prepared (too little left in the arena).
  [[nodiscard]] Reason prepare(const MovingLeastSquaresSettings& settings, int points,
                               Arena& arena) noexcept;

  // Starts a cloud. It must not change until step() returns true.
  void begin(const PointCloud& points) noexcept GLINT_NONBLOCKING;
  // Processes at most `most` points; appends each on its surface. Returns true when all are
  // processed.
  [[nodiscard]] bool step(SliceSize most, PointCloud& smoothed) noexcept GLINT_NONBLOCKING;

  // Steps of the last call of step(); they exceed its limit by at most steps_max().
  [[nodiscard]] int steps() const noexcept { return walk_.steps(); }
  [[nodiscard]] static constexpr int steps_max(
      const MovingLeastSquaresSettings& settings) noexcept {
    return k_cell_steps_max + k_surface_steps +
           settings.candidates_max * (k_gather_steps + k_near_steps + k_neighbour_steps);
  }

  // Index in the input cloud of the i-th point appended since begin().
  [[nodiscard]] int source_of(int i) const noexcept { return sources_[i]; }

  // Discarded points: `smoothed` or the grid was full; beyond the grid; too few neighbours.
  [[nodiscard]] int dropped() const noexcept { return dropped_ + grid_.dropped(); }
  [[nodiscard]] int out_of_range() const noexcept { return grid_.out_of_range(); }
  [[nodiscard]] int isolated() const noexcept { return isolated_; }
  // Points projected onto the plane because the polynomial failed; points with more candidates than
  // candidates_max.
  [[nodiscard]] int on_plane() const noexcept { return on_plane_; }
  [[nodiscard]] int candidates_exceeded() const noexcept { return candidates_exceeded_; }
  // none; cloud_full; search_full (some cut); not_prepared.
  [[nodiscard]] Reason reason() const noexcept;

 private:
  void gather_candidates() noexcept;
  void gather_neighbours(int point) noexcept;
  int smooth(int point, PointCloud& smoothed) noexcept;

  MovingLeastSquaresSettings settings_;
  NeighbourGrid grid_;
  NeighbourWalk walk_;
  Column<float> x_, y_, z_, weight_;                      // all candidates of one cell
  Column<float> near_x_, near_y_, near_z_, near_weight_;  // one point's, relative to it
  Neighbours near_;
  const PointCloud* cloud_ = nullptr;
  Column<std::int32_t> sources_;
  int appended_ = 0;
  bool prepared_ = false;
  int candidates_ = 0;
  bool cell_cut_ = false;
  int dropped_ = 0, isolated_ = 0, on_plane_ = 0, candidates_exceeded_ = 0;
};

}  // namespace glint
