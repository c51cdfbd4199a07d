// Plane segmentation of a point cloud with normals by RANSAC, largest plane first.
//
// What:     draws a sample of the points that are on no plane yet and tries planes through three of
//           its points. Scores those whose three normals agree by the number of sample points that
//           are within the threshold *and* have the plane's normal. Fits the best plane to all such
//           points, repeatedly, and assigns them to it. Stops at planes_max planes or at a plane
//           with fewer than points_min points.
// Cost:     for each plane 2 + k_plane_fits passes over the points left, `tries` candidates (three
//           points each) and at most scored_max passes over the sample.
// Worst:    a cloud without planes: one search without result. All tries miss a plane that holds
//           the fraction p of the points with probability (1 - p^3)^tries: 2 % at p = 0.1.
// Accuracy: least squares of the points within the threshold; sums in double. The sample decides
//           which plane is largest: planes within a few percent of each other may be swapped.
// Source:   Fischler and Bolles 1981, Communications of the ACM 24(6) (RANSAC); normals that must
//           agree: Schnabel, Wahl and Klein 2007, Computer Graphics Forum 26(2), section 4.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/cloud/plane_sample.hpp"
#include "kernels/cloud/plane_sums.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/slice_size.hpp"

namespace glint {

inline constexpr int k_planes_max = 32;
inline constexpr int k_plane_fits = 5;

// Steps per point listed, drawn, fitted or assigned; per candidate tried; per point of the sample
// scored; per call, including the change of phase.
inline constexpr int k_plane_list_steps = 6, k_plane_draw_steps = 24, k_plane_fit_steps = 10,
                     k_plane_take_steps = 6, k_plane_try_steps = 24, k_plane_score_steps = 2,
                     k_plane_call_steps = 256;

struct PlaneSettings {
  PlaneGate gate;
  int planes_max = 8;
  int points_min = 500;
  int candidates_max = 4096;
  int scored_max = 256;
  std::uint64_t random_seed = 1;
};

// normal . p = offset_m
struct Plane {
  Vector3 normal = Vector3::UnitZ();
  double offset_m = 0;
  double rms_m = 0;  // of its points, before their projection
  int points = 0;
};

class PlaneSearch {
 public:
  static constexpr std::uint8_t k_no_plane = 0xFF;

  // Bytes that prepare() takes from an arena.
  [[nodiscard]] static constexpr std::size_t bytes(int points) noexcept {
    return Column<std::int32_t>::bytes(points) + Column<std::uint8_t>::bytes(points) +
           PlaneSample::bytes();
  }
  // Reason: none; out_of_range (a setting, points); not_prepared (too little left in the arena).
  [[nodiscard]] Reason prepare(const PlaneSettings& settings, int points, Arena& arena) noexcept;

  // Starts a cloud. It must not change until step() returns true. Beyond the capacity only the
  // first points are used. Points without a normal are on no plane.
  void begin(const PointCloud& points) noexcept GLINT_NONBLOCKING;
  // Processes at most `most` points, tries or scored samples. Returns true when no plane is left.
  [[nodiscard]] bool step(SliceSize most) noexcept GLINT_NONBLOCKING;

  // Steps of the last call of step(); they exceed its limit by at most steps_max().
  [[nodiscard]] int steps() const noexcept { return steps_; }
  [[nodiscard]] static constexpr int steps_max() noexcept {
    return k_plane_call_steps + k_plane_score_steps * k_plane_sample + k_plane_try_steps;
  }

  [[nodiscard]] int count() const noexcept { return count_; }
  [[nodiscard]] const Plane& plane(int i) const noexcept {
    return planes_[static_cast<std::size_t>(i)];
  }
  // The plane that a point is on, or k_no_plane.
  [[nodiscard]] std::uint8_t plane_of(int point) const noexcept {
    return point < points_ ? plane_of_[point] : k_no_plane;
  }
  // none; cloud_full (points beyond the capacity); not_prepared.
  [[nodiscard]] Reason reason() const noexcept;

 private:
  enum class Phase : std::uint8_t { list, sample, tries, fit, take, done };
  void list_free(int end) noexcept;
  void draw_sample(int end) noexcept;
  void try_planes(SliceSize most) noexcept;
  [[nodiscard]] bool is_on(const CandidatePlane& candidate, int point) const noexcept;
  void add_to_fit(int end) noexcept;
  void finish_fit() noexcept;
  void assign_points(int end) noexcept;
  void next_phase() noexcept;

  PlaneSettings settings_;
  const PointCloud* cloud_ = nullptr;
  bool prepared_ = false;
  Phase phase_ = Phase::done;
  int capacity_ = 0, points_ = 0, at_ = 0, steps_ = 0;
  int free_count_ = 0, sample_size_ = 0, scored_ = 0, best_score_ = 0, fits_ = 0;
  CandidatePlane best_;
  PlaneSums sums_;
  Vector3 sum_origin_ = Vector3::Zero();  // origin of the sums' coordinates
  Column<std::int32_t> free_;
  Column<std::uint8_t> plane_of_;
  PlaneSample sample_;
  std::array<Plane, k_planes_max> planes_;
  int count_ = 0;
};

}  // namespace glint
