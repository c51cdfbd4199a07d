#include "kernels/pose/choose_reading.hpp"

#include <algorithm>
#include <cmath>

namespace glint {

bool are_apart(const Pose& one, const Pose& other, const Vector3& tip_m) noexcept {
  return (one * tip_m - other * tip_m).squaredNorm() > k_readings_apart_m * k_readings_apart_m ||
         std::abs(one.rotation.dot(other.rotation)) < k_readings_apart_dot;
}

ChosenReading choose_reading(std::span<const PoseReading> readings, double odds_before,
                             const Vector3& tip_m) noexcept {
  double surprise_most = k_followed_surprise_most;
  const PoseReading* followed = nullptr;
  for (const PoseReading& reading : readings) {
    const bool expected = reading.surprise > 0;
    if (!expected || reading.surprise > surprise_most) continue;
    surprise_most = reading.surprise;
    followed = &reading;
  }
  surprise_most += odds_before;
  const auto misfit = [&](const PoseReading& reading) {
    const double chi_square = &reading == followed
                                  ? std::min(reading.chi_square, reading.explained_most)
                                  : reading.chi_square;
    return chi_square + std::min(reading.surprise, surprise_most);
  };
  std::size_t best = 0;
  for (std::size_t i = 1; i < readings.size(); ++i) {
    if (misfit(readings[i]) < misfit(readings[best])) best = i;
  }
  ChosenReading chosen;
  chosen.index = static_cast<int>(best);
  const bool elsewhere = readings[best].surprise > surprise_most;
  chosen.turned = elsewhere && followed != nullptr;
  chosen.unexpected = elsewhere && followed == nullptr;
  bool alone = true;
  double ahead = k_odds_most;
  for (const PoseReading& reading : readings) {
    if (!are_apart(readings[best].T_camera_tool, reading.T_camera_tool, tip_m)) continue;
    alone = false;
    ahead = std::min(ahead, misfit(reading) - misfit(readings[best]));
  }
  chosen.odds = std::min(alone ? odds_before + k_no_rival_worth : ahead, k_odds_most);
  return chosen;
}

}  // namespace glint
