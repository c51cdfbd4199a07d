// Experiments on filtering and prediction of a tool's motion, with one configuration for all. Each
// is a subcommand.
#pragma once

#include "platform/lab/experiments/case_list.hpp"

namespace glint {

// Pose of a tool that has come to rest, half a second and two seconds later.
[[nodiscard]] CaseList run_static_tool(const CaseOptions& options);

// Lag of the estimate of a tool that starts from rest, at once with 0.5 m/s and 90 deg/s.
[[nodiscard]] CaseList run_lag(const CaseOptions& options);

// A tool that oscillates at 2 Hz, predicted by 25 ms.
[[nodiscard]] CaseList run_sine(const CaseOptions& options);

// Recorded motion, predicted by 25 and 50 ms, against five baseline predictors.
[[nodiscard]] CaseList run_prediction(const CaseOptions& options);

// Recorded motion with partial visibility (one or two markers) for 0.2 s: consistency of the
// filter's covariance.
[[nodiscard]] CaseList run_occlusion(const CaseOptions& options);

// A hand tracked while the camera rate drops from 45 to 5 Hz and returns, and while frames are
// dropped, duplicated, late and stamped backwards. Continuity: at every tick the state is that of
// the newest frame with a true time stamp, and the first frame after a gap makes the tool measured
// again. Age: exactly that frame's, to the nanosecond. Consistency: errors at ticks match the
// predicted covariance, within the tolerances of `occlusion`. A rejected frame changes no bit.
[[nodiscard]] CaseList run_rates(const CaseOptions& options);

// Static real tools and series of their noise model: consistency under correlated errors.
[[nodiscard]] CaseList run_correlated(const CaseOptions& options);

}  // namespace glint
