// Efficiency of the pose estimate of a single frame, relative to the Cramer-Rao bound.
//
// Points in an AHAT camera, all markers visible and labeled. Compares the weighted fit, the
// unweighted rigid fit and the baseline on the same samples. At tilts from 20 degrees on, the rms
// of position (markers' mean), tip and rotation must be within 5 % of the Cramer-Rao bound and the
// covariance consistent. Below, where the two minima of a flat tool merge, bias and flips are
// reported without a bar.
#pragma once

#include <vector>

#include "platform/formats/camera.hpp"
#include "platform/lab/experiments/case_list.hpp"

namespace glint {

[[nodiscard]] CaseList run_bound(const CaseOptions& options);

// The judged cases at one distance with any camera; without bars.
[[nodiscard]] std::vector<ExperimentCase> bound_cases_at(const Camera& camera, double range_m,
                                                         int samples, std::uint64_t seed);

}  // namespace glint
