#include "kernels/pose/choose_hypothesis.hpp"

#include <algorithm>
#include <cmath>

namespace glint {

bool are_apart(const Pose& one, const Pose& other, const Vector3& tip_m) noexcept {
  return (one * tip_m - other * tip_m).squaredNorm() >
             k_hypotheses_apart_m * k_hypotheses_apart_m ||
         std::abs(one.rotation.dot(other.rotation)) < k_hypotheses_apart_dot;
}

ChosenHypothesis choose_hypothesis(std::span<const PoseHypothesis> readings, double odds_before,
                                   const Vector3& tip_m) noexcept {
  double mahalanobis_square_max = k_followed_nis_max;
  const PoseHypothesis* followed = nullptr;
  for (const PoseHypothesis& reading : readings) {
    const bool expected = reading.mahalanobis_square > 0;
    if (!expected || reading.mahalanobis_square > mahalanobis_square_max) continue;
    mahalanobis_square_max = reading.mahalanobis_square;
    followed = &reading;
  }
  mahalanobis_square_max += odds_before;
  const auto cost = [&](const PoseHypothesis& reading) {
    const double chi_square = &reading == followed
                                  ? std::min(reading.chi_square, reading.chi_square_max)
                                  : reading.chi_square;
    return chi_square + std::min(reading.mahalanobis_square, mahalanobis_square_max);
  };
  std::size_t best = 0;
  for (std::size_t i = 1; i < readings.size(); ++i) {
    if (cost(readings[i]) < cost(readings[best])) best = i;
  }
  ChosenHypothesis chosen;
  chosen.index = static_cast<int>(best);
  const bool elsewhere = readings[best].mahalanobis_square > mahalanobis_square_max;
  chosen.switched = elsewhere && followed != nullptr;
  chosen.unexpected = elsewhere && followed == nullptr;
  bool alone = true;
  double ahead = k_odds_max;
  for (const PoseHypothesis& reading : readings) {
    if (!are_apart(readings[best].T_camera_tool, reading.T_camera_tool, tip_m)) continue;
    alone = false;
    ahead = std::min(ahead, cost(reading) - cost(readings[best]));
  }
  chosen.odds = std::min(alone ? odds_before + k_no_alternative_odds : ahead, k_odds_max);
  return chosen;
}

}  // namespace glint
