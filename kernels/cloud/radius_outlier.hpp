// Radius outlier removal: discards points with too few neighbours.
//
// What:     keeps a point if at least neighbours_min others are within radius_m of it. The output
//           is sorted by the cells of a grid.
// Cost:     sorting (neighbour_grid.hpp), then at most candidates_max distances for each point;
//           usually 16 to 32, because the search ends at the last neighbour needed.
// Worst:    many points within two radii of a point, but few within one. A point that uses up its
//           candidates is undecided: discarded and counted. At voxels of a fifth of the radius
//           there are at most 27 x 125 candidates.
// Accuracy: exact for float coordinates; each operation of a squared distance rounds once.
// Source:   Rusu and Cousins 2011, "3D is here: Point Cloud Library (PCL)" (the filter); search by
//           cells: Bentley and Friedman 1979, Computing Surveys 11(4), section 2.3.
#pragma once

#include "kernels/cloud/neighbour_grid.hpp"
#include "kernels/cloud/neighbour_walk.hpp"

namespace glint {

inline constexpr int k_outlier_steps = 40, k_candidate_steps = 2;  // per point, per candidate

struct RadiusOutlierSettings {
  float radius_m = 0.05f;
  int neighbours_min = 9;
  int candidates_max = 4096;
};

class RadiusOutlier {
 public:
  [[nodiscard]] static constexpr std::size_t bytes(int points) noexcept {
    return NeighbourGrid::bytes(points);
  }
  // Reason: none; out_of_range (a setting, points); not_prepared (too little left in the arena).
  [[nodiscard]] Reason prepare(const RadiusOutlierSettings& settings, int points,
                               Arena& arena) noexcept;

  // Starts a cloud. It must not change until step() returns true.
  void begin(const PointCloud& points) noexcept GLINT_NONBLOCKING;
  // Processes at most `most` points; appends the points kept. Returns true when all are processed.
  [[nodiscard]] bool step(SliceSize most, PointCloud& kept) noexcept GLINT_NONBLOCKING;

  // Steps of the last call of step(); they exceed its limit by at most steps_max().
  [[nodiscard]] int steps() const noexcept { return walk_.steps(); }
  [[nodiscard]] static constexpr int steps_max(const RadiusOutlierSettings& settings) noexcept {
    return k_cell_steps_max + k_outlier_steps + k_candidate_steps * (settings.candidates_max + 3);
  }

  // Discarded points: `kept` or the grid was full; beyond the grid; undecided.
  [[nodiscard]] int dropped() const noexcept { return dropped_ + grid_.dropped(); }
  [[nodiscard]] int out_of_range() const noexcept { return grid_.out_of_range(); }
  [[nodiscard]] int candidates_exceeded() const noexcept { return candidates_exceeded_; }
  // none; cloud_full; search_full (some undecided); not_prepared.
  [[nodiscard]] Reason reason() const noexcept;

 private:
  [[nodiscard]] bool has_neighbours(int point) noexcept;

  RadiusOutlierSettings settings_;
  NeighbourGrid grid_;
  NeighbourWalk walk_;
  const PointCloud* cloud_ = nullptr;
  bool prepared_ = false;
  int dropped_ = 0, candidates_exceeded_ = 0, compared_ = 0;
};

}  // namespace glint
