// How well a tool's motion is followed and foretold, one setting for all. Each is a subcommand.
#pragma once

#include "platform/experiments/case_list.hpp"

namespace glint {

// The pose of a tool that has come to rest, half a second and two seconds later.
[[nodiscard]] CaseList run_rest(const CaseOptions& options);

// How far the estimate trails a tool that sets off at once to 0.5 m/s and 90 deg/s.
[[nodiscard]] CaseList run_lag(const CaseOptions& options);

// A tool that swings at 2 Hz, foretold by 25 ms.
[[nodiscard]] CaseList run_sine(const CaseOptions& options);

// Recorded motion, foretold by 25 and 50 ms, against five rivals.
[[nodiscard]] CaseList run_prediction(const CaseOptions& options);

// Recorded motion with all markers but one or two hidden for 0.2 s: are errors as large as
// foretold?
[[nodiscard]] CaseList run_occlusion(const CaseOptions& options);

// A hand followed while the camera falls from 45 to 5 Hz and comes back, and while frames are
// dropped, doubled, late and stamped backwards. Tracked through: at every tick the state is the one
// that the newest frame with a true stamp gives, and the first frame after a gap makes the tool
// measured again. Age honest: it is that frame's, to the nanosecond. Sigma honest: errors at ticks
// are as large as foretold, to the tolerances of `occlusion`. A refused frame changes no bit.
[[nodiscard]] CaseList run_rates(const CaseOptions& options);

// Real tools at rest and series of their noise model: are errors that last as large as stated?
[[nodiscard]] CaseList run_correlated(const CaseOptions& options);

}  // namespace glint
