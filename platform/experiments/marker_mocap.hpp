// A real hand-held probe's markers, from unlabelled marker positions alone, against its published
// geometry; and how still its tip, so found, stays on a landmark. The landmark is a person's and
// moves with them in the room, so that the same figures stand beside for the published geometry.
#pragma once

#include "platform/experiments/case_list.hpp"

namespace glint {

// options.data: the folder with *probing*.c3d (points Probe1, Probe2, ..) and
// ktk_probe_geometry.csv (name,x,y,z in metres, the tip at the origin). Throws InputError where
// they are missing.
[[nodiscard]] CaseList run_marker_mocap(const CaseOptions& options);

}  // namespace glint
