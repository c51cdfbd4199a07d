// How near the pose of a single frame comes to the best that any estimator could do.
//
// Points in an AHAT camera, all markers seen and named; weighted fit, unweighted rigid fit and the
// published method on the same samples. At tilts from 20 degrees on the rms of position (markers'
// mean), tip and rotation must be within 5 % of the Cramer-Rao bound and the covariance honest;
// below, where a flat tool's two minima run into each other, bias and flips are told.
#pragma once

#include <vector>

#include "platform/experiments/case_list.hpp"
#include "platform/sensors/camera.hpp"

namespace glint {

[[nodiscard]] CaseList run_bound(const CaseOptions& options);

// The judged cases at one distance through any camera; without bars.
[[nodiscard]] std::vector<ExperimentCase> bound_cases_at(const Camera& camera, double range_m,
                                                         int samples, std::uint64_t seed);

}  // namespace glint
