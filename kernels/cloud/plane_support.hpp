// Takes points off a plane that only crosses what they belong to.
//
// What:     a plane has no end, and cuts what stands in its way: a stripe of it is near the plane,
//           and here and there has its normal by chance. A point stays on its plane if at least
//           part_min of the points within radius_m of it are on the plane, too.
// Cost:     sorting (neighbour_grid.hpp), then at most candidates_max distances for each point.
// Worst:    more than candidates_max points around one: its own row is asked first.
// Accuracy: of a stripe twice the plane's threshold wide a quarter has support at 5 cm; a point at
//           a plane's edge with nothing behind it has all, one at an edge of two planes half.
// Source:   regions that must hang together: Schnabel, Wahl and Klein 2007, Computer Graphics Forum
//           26(2), section 4.4, by a vote of neighbours instead of components of a bitmap.
#pragma once

#include "kernels/cloud/neighbour_grid.hpp"
#include "kernels/cloud/neighbour_walk.hpp"
#include "kernels/cloud/planes.hpp"

namespace glint {

// Of a point, and of each candidate; points marked in a step.
inline constexpr int k_support_steps = 8, k_vote_steps = 6, k_marked_a_step = 16;

struct PlaneSupportSettings {
  float radius_m = 0.05f;
  float part_min = 0.4f;
  int candidates_max = 4096;
};

class PlaneSupport {
 public:
  [[nodiscard]] static constexpr std::size_t bytes(int points) noexcept {
    return NeighbourGrid::bytes(points) + Column<std::uint8_t>::bytes(points);
  }
  // Reason: none; out_of_range (a setting, points); not_prepared (the arena has not enough left).
  [[nodiscard]] Reason prepare(const PlaneSupportSettings& settings, int points,
                               Arena& arena) noexcept;

  // Begins with the cloud that was searched; at once each point is on no plane. Both must
  // stay as they are until step() says true.
  void begin(const PointCloud& points, const PlaneSearch& planes) noexcept GLINT_NONBLOCKING;
  // Goes on for at most `most` points. True when all are judged.
  [[nodiscard]] bool step(SliceSize most) noexcept GLINT_NONBLOCKING;

  // Of the last call of step(), at most steps_max() beyond those that it was given.
  [[nodiscard]] int steps() const noexcept { return steps_; }
  [[nodiscard]] static constexpr int steps_max(const PlaneSupportSettings& settings) noexcept {
    return k_cell_steps_max + k_support_steps + k_vote_steps * settings.candidates_max;
  }

  // The plane that a point is on and stays on, or PlaneSearch::k_no_plane.
  [[nodiscard]] std::uint8_t plane_of(int point) const noexcept {
    return point < marked_ ? plane_of_[point] : PlaneSearch::k_no_plane;
  }
  // Points taken off their plane.
  [[nodiscard]] int taken_off() const noexcept { return taken_off_; }

 private:
  [[nodiscard]] bool is_supported(int point, std::uint8_t plane) noexcept;

  PlaneSupportSettings settings_;
  NeighbourGrid grid_;
  NeighbourWalk walk_;
  const PlaneSearch* planes_ = nullptr;
  Column<std::uint8_t> plane_of_;
  bool prepared_ = false;
  int points_ = 0, marked_ = 0, capacity_ = 0, taken_off_ = 0, looked_at_ = 0, steps_ = 0;
};

}  // namespace glint
