// Statistical test of touches of two points and a rest against the stated error model.
//
// What:     the tips of the touches are y = X p + e, p the two points, e with the joint covariance
//           C of all stated errors. Repeatability: chi-square of the residuals of generalised least
//           squares. Scale: error of the points' distance against its variance. Rest: chi-square of
//           the one-second means about their common mean. Calibration: maximum-likelihood
//           calibration errors from touches, distance and residuals of single fits, each against
//           its stated sigma (platform/tools/report/calibration_findings).
// Source:   generalised least squares: Aitken 1936; tests at a joint level: Bonferroni 1936.
#pragma once

#include <string>
#include <vector>

#include "platform/tools/report/calibration_findings.hpp"
#include "platform/tools/verify/tip_sightings.hpp"

namespace glint {

inline constexpr int k_touches_min = 10;      // of the first point
inline constexpr double k_confidence = 0.95;  // of the verdict as a whole

struct VerifySettings {
  double distance_m = 0;        // of the two points
  double distance_sigma_m = 0;  // its standard deviation
};

struct Check {
  double measured_m = 0, stated_m = 0;  // root mean square; of the distance its error and its sigma
  double probability = 1;               // of an error this large under the stated model (p-value)
  bool agrees = true;
};

struct Verification {
  int first_touches = 0, second_touches = 0, other_holds = 0;
  double rest_s = 0, range_m = 0, distance_m = 0;
  Vector3 spread_rad = Vector3::Zero();  // spread of the tool's directions, ascending
  // What the recording lacks, if single fits alone show an error; the three checks are then not
  // evaluated.
  std::string missing;
  Check repeatability, scale, rest;
  std::vector<CalibrationFinding> calibration;
  double level = 0;  // significance level of each test; a smaller probability disagrees
  bool agrees = true;
};

// Throws InputError, naming the series and what is expected, for too few touches of a point,
// touches of equal orientation, and no rest.
[[nodiscard]] Verification verify_touches(const TipSeries& series, const VerifySettings& settings);

// Returns what the check does not cover, a line each.
[[nodiscard]] std::vector<std::string> not_covered(const Verification& verification);

}  // namespace glint
