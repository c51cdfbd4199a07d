// A sample of a cloud's points with normals, and planes through three of them.
//
// What:     candidate_of() gives the plane through three points drawn by a counter, if all three
//           normals are the plane's; score() how many of the sample lie on a plane.
// Cost:     a try 30 ns; a score linear in the sample, by fours.
// Worst:    points on a line, or three times the same: no plane.
// Accuracy: float; the planes are only compared here.
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

// What lies on a plane: near it, and with its normal up to the sign.
struct PlaneGate {
  float threshold_m = 0.01f;
  float normal_cosine_min = 0.93969262f;  // of 20 degrees
};

// Numbers that follow from seed, stream and counter alone.
// Source: Steele, Lea and Flood 2014, fig. 13, at the counter's place.
[[nodiscard]] inline std::uint64_t random_at(std::uint64_t seed, int stream, int counter) {
  const std::uint64_t place =
      (static_cast<std::uint64_t>(stream) << 40) + static_cast<std::uint64_t>(counter) + 1;
  std::uint64_t z = seed + place * 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

class PlaneSample {
 public:
  [[nodiscard]] static constexpr std::size_t bytes() noexcept {
    return 6 * Column<float>::bytes(k_plane_sample);
  }
  // Reason: none, or not_prepared: the arena has not enough left.
  [[nodiscard]] Reason prepare(Arena& arena) noexcept;

  void clear() noexcept { count_ = 0; }
  // A point of the cloud; at most k_plane_sample of them.
  void add(const PointCloud& cloud, int point) noexcept GLINT_NONBLOCKING;
  [[nodiscard]] int count() const noexcept { return count_; }

  // False: the three points that `drawn` stands for have no plane with their normals.
  [[nodiscard]] bool candidate_of(std::uint64_t drawn, const PlaneGate& gate,
                                  CandidatePlane& out) const noexcept GLINT_NONBLOCKING;
  [[nodiscard]] int score(const CandidatePlane& plane,
                          const PlaneGate& gate) const noexcept GLINT_NONBLOCKING;

 private:
  Column<float> x_, y_, z_, nx_, ny_, nz_;
  int count_ = 0;
};

}  // namespace glint
