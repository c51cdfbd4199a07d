// The large flat faces of a cloud with normals, the largest first.
//
// What:     of the points that are on no plane yet a sample is drawn; planes through three of its
//           points are tried, those whose three normals agree are scored by how much of the sample
//           lies within the threshold *and* has the plane's normal; the best one is fitted to all
//           points that do so, again and again, and takes them. Until planes_max, or a plane has
//           fewer than points_min.
// Cost:     for each plane 2 + k_plane_fits passes over the points left, tries (three points each)
//           and at most scored_max passes over the sample.
// Worst:    a cloud without planes: one search, for nothing. A plane that holds the part p of the
//           points is missed by all tries with probability (1 - p^3)^tries: 2 % at p = 0.1.
// Accuracy: least squares of the points within the threshold; sums in double. Which is the largest
//           the sample says: planes within a few percent of each other may change places.
// Source:   Fischler and Bolles 1981, Communications of the ACM 24(6) (the tries); normals that
//           must agree: Schnabel, Wahl and Klein 2007, Computer Graphics Forum 26(2), section 4.
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

// Of a point that is listed, drawn, fitted or taken; of three that are tried; of each point of the
// sample that is scored; of a call, with what stands between two phases.
inline constexpr int k_plane_list_steps = 6, k_plane_draw_steps = 24, k_plane_fit_steps = 10,
                     k_plane_take_steps = 6, k_plane_try_steps = 24, k_plane_score_steps = 2,
                     k_plane_turn_steps = 256;

struct PlaneSettings {
  PlaneGate gate;
  int planes_max = 8;
  int points_min = 500;
  int tries = 4096;
  int scored_max = 256;
  std::uint64_t seed = 1;
};

// normal . p = offset_m
struct Plane {
  Vector3 normal = Vector3::UnitZ();
  double offset_m = 0;
  double rms_m = 0;  // of its points, before they are moved
  int points = 0;
};

class PlaneSearch {
 public:
  static constexpr std::uint8_t k_no_plane = 0xFF;

  // What prepare() takes of an arena.
  [[nodiscard]] static constexpr std::size_t bytes(int points) noexcept {
    return Column<std::int32_t>::bytes(points) + Column<std::uint8_t>::bytes(points) +
           PlaneSample::bytes();
  }
  // Reason: none; out_of_range (a setting, points); not_prepared (the arena has not enough left).
  [[nodiscard]] Reason prepare(const PlaneSettings& settings, int points, Arena& arena) noexcept;

  // Begins with this cloud, which must stay as it is until step() says true. Of a cloud beyond the
  // capacity the first points are looked at. Points without a normal are on no plane.
  void begin(const PointCloud& points) noexcept GLINT_NONBLOCKING;
  // Goes on for at most `most` points, tries or scored samples. True when no plane is left.
  [[nodiscard]] bool step(SliceSize most) noexcept GLINT_NONBLOCKING;

  // Of the last call of step(), at most steps_max() beyond those that it was given.
  [[nodiscard]] int steps() const noexcept { return steps_; }
  [[nodiscard]] static constexpr int steps_max() noexcept {
    return k_plane_turn_steps + k_plane_score_steps * k_plane_sample + k_plane_try_steps;
  }

  [[nodiscard]] int count() const noexcept { return count_; }
  [[nodiscard]] const Plane& plane(int i) const noexcept {
    return planes_[static_cast<std::size_t>(i)];
  }
  // The plane that a point is on, or k_no_plane.
  [[nodiscard]] std::uint8_t plane_of(int point) const noexcept {
    return point < points_ ? plane_of_[point] : k_no_plane;
  }
  // none; cloud_full (points not looked at); not_prepared.
  [[nodiscard]] Reason reason() const noexcept;

 private:
  enum class Phase : std::uint8_t { list, sample, tries, fit, take, done };
  void list_free(int end) noexcept;
  void draw_sample(int end) noexcept;
  void try_planes(SliceSize most) noexcept;
  [[nodiscard]] bool is_on(const CandidatePlane& candidate, int point) const noexcept;
  void add_to_fit(int end) noexcept;
  void finish_fit() noexcept;
  void take_points(int end) noexcept;
  void next_phase() noexcept;

  PlaneSettings settings_;
  const PointCloud* cloud_ = nullptr;
  bool prepared_ = false;
  Phase phase_ = Phase::done;
  int capacity_ = 0, points_ = 0, at_ = 0, steps_ = 0;
  int free_count_ = 0, sample_size_ = 0, scored_ = 0, best_score_ = 0, fits_ = 0;
  CandidatePlane best_;
  PlaneSums sums_;
  Vector3 around_ = Vector3::Zero();  // sums are of coordinates from here
  Column<std::int32_t> free_;
  Column<std::uint8_t> plane_of_;
  PlaneSample sample_;
  std::array<Plane, k_planes_max> planes_;
  int count_ = 0;
};

}  // namespace glint
