// Whether touches of two points and a rest agree with what is stated of a tracker's errors.
//
// What:     the touches' tips are y = X p + e, p the two points, e of the joint covariance C of all
//           stated errors. Repeatability: chi-square of the residuals of generalised least squares.
//           Scale: the points' distance beside the known one, and its variance. Rest: chi-square of
//           the means over each second about their common mean. Calibration: the most likely
//           calibration errors by touches, distance and the residuals of single fits, each beside
//           what is stated (platform/report/calibration_findings).
// Source:   generalised least squares: Aitken 1936; tests at a joint level: Bonferroni 1936.
#pragma once

#include <string>
#include <vector>

#include "platform/report/calibration_findings.hpp"
#include "platform/verify/tip_sightings.hpp"

namespace glint {

inline constexpr int k_touches_min = 10;      // of the first point
inline constexpr double k_confidence = 0.95;  // of the verdict as a whole

struct VerifySettings {
  double distance_m = 0;        // of the two points
  double distance_sigma_m = 0;  // how well it is known
};

struct Check {
  double measured_m = 0, stated_m = 0;  // root mean square; of the distance its error and its sigma
  double probability = 1;               // of an error this large, were it as stated
  bool agrees = true;
};

struct Verification {
  int first_touches = 0, second_touches = 0, other_holds = 0;
  double rest_s = 0, range_m = 0, distance_m = 0;
  Vector3 spread_rad = Vector3::Zero();  // by how much the tool's directions differ, rising
  // What the recording lacks, where single fits alone show an error: the three are not judged then.
  std::string lacks;
  Check repeatability, scale, rest;
  std::vector<CalibrationFinding> calibration;
  double level = 0;  // an event less probable than this, were all as stated, does not agree
  bool agrees = true;
};

// Throws InputError, naming the series: too few touches of a point, touches that are all alike, no
// rest, and what is expected.
[[nodiscard]] Verification verify_touches(const TipSeries& series, const VerifySettings& settings);

// What such a check leaves open, a line each.
[[nodiscard]] std::vector<std::string> not_shown(const Verification& verification);

}  // namespace glint
