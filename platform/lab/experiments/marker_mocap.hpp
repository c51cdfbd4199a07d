// Validation of tool geometry calibration on a real hand-held probe: its markers from unlabelled
// marker positions against the published geometry, and the scatter of its tip on a landmark. The
// landmark moves with a person in the room; so the same figures are reported for the published
// geometry.
#pragma once

#include "platform/lab/experiments/case_list.hpp"

namespace glint {

// options.data: the folder with *probing*.c3d (points Probe1, Probe2, ..) and
// ktk_probe_geometry.csv (name,x,y,z in metres, the tip at the origin). Throws InputError if they
// are missing.
[[nodiscard]] CaseList run_marker_mocap(const CaseOptions& options);

}  // namespace glint
