// Pivot calibration and two-body tips of the computer-integrated surgery course, against its
// answers: its pivot posts by an electromagnetic and an optical tracker (problem 1), and the tip of
// a pointer in a second body's frame (problem 3).
#pragma once

#include "platform/experiments/case_list.hpp"

namespace glint {

// options.data: the folder that holds pa1/ and pa3/. Throws InputError where both are missing or a
// file of a case is.
[[nodiscard]] CaseList run_cis_pivot(const CaseOptions& options);

}  // namespace glint
