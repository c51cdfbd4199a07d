// Validation of pivot calibration and two-body tips against the answers of the computer-integrated
// surgery course: pivot posts by an electromagnetic and an optical tracker (problem 1), the tip of
// a pointer in a second body's frame (problem 3).
#pragma once

#include "platform/lab/experiments/case_list.hpp"

namespace glint {

// options.data: the folder with pa1/ and pa3/. Throws InputError if both are missing or if a case's
// file is missing.
[[nodiscard]] CaseList run_cis_pivot(const CaseOptions& options);

}  // namespace glint
