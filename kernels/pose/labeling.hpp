// Labeling: assignment of measured markers to a tool's markers, result of the correspondence
// search.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/geometry.hpp"
#include "kernels/limits.hpp"
#include "kernels/reason.hpp"

namespace glint {

struct Labeling {
  // marker[i] is the index into Markers of the tool's marker i, -1 if not visible.
  std::array<std::int16_t, k_markers_per_tool_max> marker{};
  int count = 0;     // visible markers, at least 3
  double rms_m = 0;  // of the rigid fit over them
  // Log prior ratio, scaled to m^2, if every marker is within the gate of its predicted position;
  // else 0. Tools that claim the same markers are compared by count rms^2 minus this.
  double log_prior_ratio_m2 = 0;
  Pose T_camera_tool;  // pose of that fit
};

// One tool's labelings, best first: more markers before fewer, then the smaller rms.
struct Labelings {
  std::array<Labeling, k_labelings_max> items;
  int count = 0;
  std::uint32_t hypotheses = 0;  // partial assignments tried
  Reason reason = Reason::none;  // why there is no labeling, or search_full
};

}  // namespace glint
