// Smooths a surface's points: each is moved onto a curved sheet through its neighbours.
//
// What:     local_surface.hpp for every point of a cloud, over all points within radius_m of it.
//           What comes out is sorted by the cells of a grid and has normals.
// Cost:     sorting (neighbour_grid.hpp); for each point at most candidates_max distances, and what
//           local_surface takes for those that are near: some 80 and 30 at voxels of a third of the
//           radius.
// Worst:    more than candidates_max points in the nine rows of cells around a point: the point's
//           own row counts first, then the others in their order, and the cell is counted. A point
//           with fewer than k_plane_neighbours_min neighbours, itself included, is left out.
// Accuracy: order 2 leaves the bias of a curved surface below 0.6 mm at a radius of curvature of
//           50 mm (moving_least_squares_accuracy_test.cpp).
// Source:   Alexa et al. 2003, IEEE Transactions on Visualization and Computer Graphics 9(1).
#pragma once

#include "kernels/cloud/local_surface.hpp"
#include "kernels/cloud/neighbour_grid.hpp"
#include "kernels/cloud/neighbour_walk.hpp"

namespace glint {

// Of a cell for each candidate; of a point beside them, for each candidate, for each neighbour.
inline constexpr int k_gather_steps = 4, k_surface_steps = 600, k_near_steps = 5,
                     k_neighbour_steps = 12;

// What a neighbour counts: as much as any other, or as much as the measurements that it is the mean
// of. Where many measurements make a voxel's point, those in the middle of the noise have far more
// of them than those at its edge, and equal weights bend the surface.
enum class NeighbourWeights : std::uint8_t { equal, by_measurements };

struct MovingLeastSquaresSettings {
  float radius_m = 0.03f;
  int candidates_max = 4096;
  NeighbourWeights weights = NeighbourWeights::by_measurements;
};

class MovingLeastSquares {
 public:
  // What prepare() takes of an arena.
  [[nodiscard]] static constexpr std::size_t bytes(const MovingLeastSquaresSettings& settings,
                                                   int points) noexcept {
    return NeighbourGrid::bytes(points) + Column<std::int32_t>::bytes(points) +
           8 * Column<float>::bytes(settings.candidates_max + k_four_spare);
  }
  // Reason: none; out_of_range (a setting, points); not_prepared (the arena has not enough left).
  [[nodiscard]] Reason prepare(const MovingLeastSquaresSettings& settings, int points,
                               Arena& arena) noexcept;

  // Begins with this cloud, which must stay as it is until step() says true.
  void begin(const PointCloud& points) noexcept GLINT_NONBLOCKING;
  // Goes on for at most `most` points, appending each on its surface. True when all are there.
  [[nodiscard]] bool step(SliceSize most, PointCloud& smoothed) noexcept GLINT_NONBLOCKING;

  // Of the last call of step(), at most steps_max() beyond those that it was given.
  [[nodiscard]] int steps() const noexcept { return walk_.steps(); }
  [[nodiscard]] static constexpr int steps_max(
      const MovingLeastSquaresSettings& settings) noexcept {
    return k_cell_steps_max + k_surface_steps +
           settings.candidates_max * (k_gather_steps + k_near_steps + k_neighbour_steps);
  }

  // Which point of the cloud the i-th one appended since begin() was.
  [[nodiscard]] int source_of(int i) const noexcept { return sources_[i]; }

  // Points left out: `smoothed` or the grid was full; beyond the grid; with too few neighbours.
  [[nodiscard]] int dropped() const noexcept { return dropped_ + grid_.dropped(); }
  [[nodiscard]] int out_of_range() const noexcept { return grid_.out_of_range(); }
  [[nodiscard]] int lonely() const noexcept { return lonely_; }
  // Points on a plane, for no sheet would do; points whose candidates were not all looked at.
  [[nodiscard]] int flat() const noexcept { return flat_; }
  [[nodiscard]] int cut() const noexcept { return cut_; }
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
  int dropped_ = 0, lonely_ = 0, flat_ = 0, cut_ = 0;
};

}  // namespace glint
