// Nearest-neighbour search within a radius by spatial hashing, in a table of fixed size.
//
// What:     points sorted by cell; the hash of a cell's index finds its points.
// Cost:     building is linear; a search visits the 27 to 125 cells around its point, nearest
//           first, and the points in them.
// Worst:    all points in one cell: a search compares k_grid_points_compared_max of them, in the
// order
//           of input, and returns the nearest of those.
// Accuracy: exact, except in the worst case above; of equally near points the first.
// Source:   Teschner et al. 2003, "Optimized spatial hashing", section 4.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/nonblocking.hpp"
#include "kernels/reason.hpp"
#include "kernels/registration/triangle.hpp"
#include "kernels/slice_size.hpp"

namespace glint {

inline constexpr int k_grid_points_compared_max = 4096;  // per search
inline constexpr int k_grid_probes_max = 64;             // per look-up of a cell

// Steps per cell cleared, point inserted, cell summed, point placed; per cell looked up, per probe;
// per point compared.
inline constexpr int k_grid_clear_steps = 1, k_grid_insert_steps = 24, k_grid_sum_steps = 3,
                     k_grid_scatter_steps = 8, k_grid_find_steps = 10, k_grid_probe_steps = 2,
                     k_grid_point_steps = 4;
inline constexpr int k_grid_insert_steps_max =
    k_grid_insert_steps + k_grid_probes_max * k_grid_probe_steps;
inline constexpr int k_nearest_steps_max =
    125 * (k_grid_find_steps + k_grid_probes_max * k_grid_probe_steps) +
    k_grid_points_compared_max * k_grid_point_steps;

struct Nearest {
  std::int32_t index = -1;  // index in the input; -1: none within the radius
  float square_m2 = 0;
};

class PointGrid {
 public:
  // Allocates memory for points_max points.
  [[nodiscard]] Reason prepare(int points_max);

  // Builds the grid of all points with finite coordinates. Cells are reach_m / 2 wide; nearest()
  // searches up to reach_m. Reason::not_prepared: more points than prepared for; out_of_range:
  // invalid reach.
  [[nodiscard]] Reason build(std::span<const Vector3f> points,
                             double reach_m) noexcept GLINT_NONBLOCKING;

  // The same in slices: begin_build(), then build_step() until it returns true. The points must not
  // change meanwhile.
  [[nodiscard]] Reason begin_build(std::span<const Vector3f> points,
                                   double reach_m) noexcept GLINT_NONBLOCKING;
  [[nodiscard]] bool build_step(StepBudget& budget) noexcept GLINT_NONBLOCKING;

  // Requires radius_m <= reach_m. Takes at most k_nearest_steps_max steps.
  [[nodiscard]] Nearest nearest(const Vector3f& point,
                                float radius_m) const noexcept GLINT_NONBLOCKING;

  [[nodiscard]] Nearest nearest(const Vector3f& point, float radius_m,
                                StepBudget& budget) const noexcept GLINT_NONBLOCKING;

  [[nodiscard]] int size() const { return count_; }

 private:
  struct Cell {
    std::uint64_t key = 0;  // 0: free
    std::int32_t begin = 0, end = 0;
  };
  struct Entry {
    Vector3f point;
    std::int32_t index;
  };
  enum class Phase : std::uint8_t { clear, insert, sum, place, done };
  [[nodiscard]] const Cell* find(std::uint64_t key, int& probes) const noexcept;
  void insert(std::size_t point) noexcept;
  [[nodiscard]] std::uint64_t key_of(const Eigen::Vector3i& cell) const noexcept;
  [[nodiscard]] Eigen::Vector3i cell_of(const Vector3f& point) const noexcept;

  std::vector<Cell> cells_;
  std::vector<Entry> entries_;
  std::vector<std::int32_t> slot_of_;  // of each input point; -1: not stored
  float cell_m_ = 1;
  float reach_m_ = 0;
  int count_ = 0;
  std::span<const Vector3f> points_;  // during the build
  Phase phase_ = Phase::done;
  int at_ = 0;
  std::int32_t begin_ = 0;
  int probes_ = 0;  // of the last insert
};

}  // namespace glint
