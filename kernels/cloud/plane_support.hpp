// Removes points from a plane that only intersects their surface, by a vote of the neighbours.
//
// What:     a plane is infinite and intersects objects on its way: points in a stripe of the object
//           are near the plane, and some have its normal by chance. A point stays on its plane if
//           at least support_share_min of the points within radius_m of it are on that plane too.
// Cost:     sorting (neighbour_grid.hpp), then at most candidates_max distances for each point.
// Worst:    more than candidates_max points around a point: its own row counts first.
// Accuracy: in a stripe twice the plane's threshold wide a quarter of the neighbours within 5 cm
//           are on the plane. At a free edge of a plane all are, at an edge between two planes
//           half.
// Source:   connected regions: Schnabel, Wahl and Klein 2007, Computer Graphics Forum 26(2),
//           section 4.4; a vote of neighbours replaces the connected components of a bitmap.
#pragma once

#include "kernels/cloud/neighbour_grid.hpp"
#include "kernels/cloud/neighbour_walk.hpp"
#include "kernels/cloud/planes.hpp"

namespace glint {

// Steps per point, per candidate; points marked per step.
inline constexpr int k_support_steps = 8, k_vote_steps = 6, k_marked_per_step = 16;

struct PlaneSupportSettings {
  float radius_m = 0.05f;
  float support_share_min = 0.4f;
  int candidates_max = 4096;
};

class PlaneSupport {
 public:
  [[nodiscard]] static constexpr std::size_t bytes(int points) noexcept {
    return NeighbourGrid::bytes(points) + Column<std::uint8_t>::bytes(points);
  }
  // Reason: none; out_of_range (a setting, points); not_prepared (too little left in the arena).
  [[nodiscard]] Reason prepare(const PlaneSupportSettings& settings, int points,
                               Arena& arena) noexcept;

  // Starts with the cloud that `planes` was computed from. Both must not change until step()
  // returns true. Until then plane_of() returns k_no_plane for undecided points.
  void begin(const PointCloud& points, const PlaneSearch& planes) noexcept GLINT_NONBLOCKING;
  // Processes at most `most` points. Returns true when all are processed.
  [[nodiscard]] bool step(SliceSize most) noexcept GLINT_NONBLOCKING;

  // Steps of the last call of step(); they exceed its limit by at most steps_max().
  [[nodiscard]] int steps() const noexcept { return steps_; }
  [[nodiscard]] static constexpr int steps_max(const PlaneSupportSettings& settings) noexcept {
    return k_cell_steps_max + k_support_steps + k_vote_steps * settings.candidates_max;
  }

  // The plane that a point stays on, or PlaneSearch::k_no_plane.
  [[nodiscard]] std::uint8_t plane_of(int point) const noexcept {
    return point < marked_ ? plane_of_[point] : PlaneSearch::k_no_plane;
  }
  // Points removed from their plane.
  [[nodiscard]] int removed() const noexcept { return removed_; }

 private:
  [[nodiscard]] bool is_supported(int point, std::uint8_t plane) noexcept;

  PlaneSupportSettings settings_;
  NeighbourGrid grid_;
  NeighbourWalk walk_;
  const PlaneSearch* planes_ = nullptr;
  Column<std::uint8_t> plane_of_;
  bool prepared_ = false;
  int points_ = 0, marked_ = 0, capacity_ = 0, removed_ = 0, compared_ = 0, steps_ = 0;
};

}  // namespace glint
