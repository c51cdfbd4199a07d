// How often a tool of four markers is found, and found wrongly, as the range noise grows.
//
// Points in an AHAT camera at half a metre, the tool's plane tilted by up to 45 degrees; strays
// around it, whose images touch no other; without and with a prior (10 mm and 5 degrees rms).
// Correspondence with the gate of the declared noise, then the weighted fit of every labeling kept,
// decided by chi-square; beside it the labeling and the pose of the least unweighted rms. Found: a
// pose is called measured. Wrong: with a wrong marker assignment. Gross: as is_gross() of
// platform/runtime/session/gross.hpp defines it. Last rows: the shipped graph (noise_graph.hpp).
#pragma once

#include "platform/lab/experiments/case_list.hpp"

namespace glint {

[[nodiscard]] CaseList run_noise(const CaseOptions& options);

}  // namespace glint
