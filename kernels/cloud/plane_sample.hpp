// RANSAC sample of a point cloud with normals: candidate planes through three points, and their
// scores.
//
// What:     candidate_of() computes the plane through three points selected by a random number, if
//           all three normals agree with it; score() counts the sample's points on a plane.
// Cost:     a candidate 30 ns; a score linear in the sample, by fours.
// Worst:    collinear or coincident points: no plane.
// Accuracy: float; planes are only compared here.
// Source:   Fischler and Bolles 1981, Communications of the ACM 24(6); Schnabel, Wahl and Klein
//           2007, Computer Graphics Forum 26(2), section 4 (normals that must agree).
#pragma once

#include <cstdint>

#include "kernels/cloud/point_cloud.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr int k_plane_sample = 2048;

struct CandidatePlane {
  float nx = 0, ny = 0, nz = 1, offset_m = 0;  // n . p = offset
};

// Condition for a point on a plane: near it, and with its normal up to the sign.
struct PlaneGate {
  float threshold_m = 0.01f;
  float normal_cosine_min = 0.93969262f;  // cosine of 20 degrees
};

// Counter-based random number (SplitMix64): a function of random seed, stream and counter alone.
// Source: Steele, Lea and Flood 2014, fig. 13, evaluated at the counter.
[[nodiscard]] inline std::uint64_t random_at(std::uint64_t seed, int stream, int counter) {
  const std::uint64_t index =
      (static_cast<std::uint64_t>(stream) << 40) + static_cast<std::uint64_t>(counter) + 1;
  std::uint64_t z = seed + index * 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

class PlaneSample {
 public:
  [[nodiscard]] static constexpr std::size_t bytes() noexcept {
    return 6 * Column<float>::bytes(k_plane_sample);
  }
  // Reason: none; not_prepared (too little left in the arena).
  [[nodiscard]] Reason prepare(Arena& arena) noexcept;

  void clear() noexcept { count_ = 0; }
  // Adds a point of the cloud; keeps at most k_plane_sample.
  void add(const PointCloud& cloud, int point) noexcept GLINT_NONBLOCKING;
  [[nodiscard]] int count() const noexcept { return count_; }

  // Returns false if the three points selected by `drawn` give no plane that agrees with their
  // normals.
  [[nodiscard]] bool candidate_of(std::uint64_t drawn, const PlaneGate& gate,
                                  CandidatePlane& out) const noexcept GLINT_NONBLOCKING;
  [[nodiscard]] int score(const CandidatePlane& plane,
                          const PlaneGate& gate) const noexcept GLINT_NONBLOCKING;

 private:
  Column<float> x_, y_, z_, nx_, ny_, nz_;
  int count_ = 0;
};

}  // namespace glint
